// Bounds of numbers on the command line, with their texts.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace verification {

// Check of a finite number; CLI11's own checks accept NaN and infinity.
template <class Accept>
CLI::Validator finite_number(const std::string& rule, Accept accept) {
  return {[rule, accept](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && std::isfinite(value) && accept(value)
                       ? std::string()
                       : fmt::format("found {}, expected a number {}", text, rule);
          },
          rule};
}

inline CLI::Validator at_least(int low) {
  return finite_number(fmt::format(">= {}", low), [low](double value) { return value >= low; });
}

inline CLI::Validator above(int low) {
  return finite_number(fmt::format("> {}", low), [low](double value) { return value > low; });
}

}  // namespace verification

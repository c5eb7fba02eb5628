// Bounds of numbers on the command line, in words.
#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <string>

namespace verification {

inline CLI::Validator at_least(int low) {
  return {[low](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && value >= low
                       ? std::string()
                       : fmt::format("found {}, expected a number >= {}", text, low);
          },
          fmt::format(">= {}", low)};
}

}  // namespace verification

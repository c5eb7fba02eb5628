// The only exception of the library: a status of the C ABI and a message for a person.
#pragma once

#include <grainlaw/grainlaw.h>

#include <stdexcept>
#include <string>

namespace grainlaw::core {

struct Error : std::runtime_error {
  Error(grainlaw_status code, const std::string& message)
      : std::runtime_error(message), status(code) {}
  grainlaw_status status;
};

}  // namespace grainlaw::core

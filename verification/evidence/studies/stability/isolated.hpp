// Work in a process of its own, so that a crash or a hang becomes a result.
#pragma once

#include <functional>
#include <string>

namespace verification::stability {

struct Answer {
  std::string text;
  std::string failure;  // "", or how the process ended
};

// Calls work() in a child process and returns its text; ends the child after `seconds` of CPU
// time, or twenty times as long on the wall. `work` must not throw. Throws ComputationError when
// there can be no child.
Answer run_isolated(const std::function<std::string()>& work, double seconds);

}  // namespace verification::stability

// A load step solved in as many parts as it takes.
#pragma once

#include <fmt/format.h>

#include "app/library.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace verification {

// How an attempt at a part of a load step ended.
struct Attempt {
  bool converged = false;
  double ratio = 0.5;  // of the part that seems feasible
  std::string reason;
};

// From one time to another: attempt(next) goes from the time of the last success to `next`, whole or
// not at all. After a failure the part is cut by the ratio, at most to a tenth and at least to half;
// after a success the next one is twice as long. Returns the number of cuts. Throws ComputationError
// when 2^-max_cuts of the step fails.
template <class Function>
int solve_in_parts(double from, double to, int number, int max_cuts, Function&& attempt) {
  const double smallest = std::ldexp(to - from, -max_cuts);
  double done = from;
  double part = to - from;
  int cuts = 0;
  do {
    const double next = done + part > to - 1e-9 * (to - from) ? to : done + part;
    const Attempt result = attempt(next);
    if (result.converged) {
      part = std::min(to - next, 2 * (next - done));
      done = next;
      continue;
    }
    ++cuts;
    part = (next - done) * std::clamp(result.ratio, 0.1, 0.5);
    if (part < smallest || to == from)
      throw ComputationError(
          fmt::format("load step {} failed at {:.1e} of the run: {}", number, part, result.reason));
  } while (done < to);
  return cuts;
}

}  // namespace verification

// A trial as bytes and back, with what the next trial may start from.
#pragma once

#include "increment/configuration.hpp"

#include <vector>

namespace grainlaw::core {

// What bytes hold of a trial.
template <int D>
struct SavedTrialOf {
  bool exists = false;
  bool loose = false, advanced = false;  // how it was found
  Configuration<D> configuration;
  std::vector<float> slopes;
};

}  // namespace grainlaw::core

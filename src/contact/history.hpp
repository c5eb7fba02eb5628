// What a touching contact remembers.
#pragma once

#include <array>
#include <cstdint>

namespace grainlaw {

// Branch l = x_j - x_i + F H0 shift.
struct ContactHistory {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::array<std::int16_t, 2> shift{};
  bool sliding = false;  // at the friction limit
  bool bonded = false;
  double tangential_force = 0;  // on j, along the branch normal turned by +90 degrees [N]
};

}  // namespace grainlaw

// What the servo for frames keeps from call to call.
#pragma once

#include "contact/records.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace grainlaw::core {

struct ServoMemory {
  std::vector<unsigned char> frozen;  // bits of what the relaxations do not move, by nodes
  std::vector<ForceRecord<2>> raw;    // before reduction
  // Of nodes under uniform stress.
  std::vector<std::array<double, 2>> area;
  std::vector<std::size_t> particle;
};

}  // namespace grainlaw::core

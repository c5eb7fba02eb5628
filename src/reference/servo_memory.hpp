// Workspace of the servo, reused between calls.
#pragma once

#include "contact/records.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace grainlaw::core {

struct ServoMemory {
  std::vector<unsigned char> frozen;  // [nodes] fixed_bit of components the relaxation leaves in
                                      // place
  std::vector<ForceRecord<2>> raw;    // forces before reduction to nodes
  // Areas A_q of the nodes under uniform stress.
  std::vector<std::array<double, 2>> area;
  std::vector<std::size_t> particle;
};

}  // namespace grainlaw::core

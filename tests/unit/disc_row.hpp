// Discs in a row that closes on itself in a cell, with room across.
#pragma once

#include "packing/packing.hpp"

#include <vector>

namespace grainlaw::core::test {

inline Packing disc_row(const std::vector<double>& radii, double overlap) {
  Packing packing;
  packing.radius = radii;
  double length = 0;
  for (const double r : radii) {
    packing.position.push_back(length + r);
    length += 2 * r - overlap;
  }
  packing.position.resize(2 * radii.size(), 2e-3);
  packing.cell = {length, 0, 0, 5e-3};
  packing.thickness = 0.1;
  return packing;
}

}  // namespace grainlaw::core::test

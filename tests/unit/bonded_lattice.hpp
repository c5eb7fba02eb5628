// A disc that is bonded to itself.
#pragma once

#include "support.hpp"

namespace grainlaw::core::test {

// Bonded to its images to the right and above, without stress: a square lattice.
inline MaterialDescription bonded_lattice(const ContactLaw& law) {
  MaterialDescription description;
  auto& packing = description.packing;
  packing.cell = {2, 0, 0, 2};
  packing.radius = {1};
  packing.position = {0.3, 0.4};
  packing.thickness = 0.5;
  description.law = law;
  description.law.bond.gap = 1e-6;
  description.solver.tolerance = 1e-10;
  return description;
}

}  // namespace grainlaw::core::test

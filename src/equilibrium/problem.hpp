// What stays the same for every increment of a material.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/law.hpp"
#include "packing/packing.hpp"

namespace grainlaw {

struct Problem {
  const Packing* packing = nullptr;
  const ContactLaw* law = nullptr;
  const BoundarySpace* space = nullptr;
  double force_floor = 0;  // residuals are relative to max(mean normal force, this) [N]
  double tolerance = 0;    // of equilibria; contacts that carry about as little are none [-]

  [[nodiscard]] int components() const { return law->rotating() ? 3 : 2; }
};

}  // namespace grainlaw

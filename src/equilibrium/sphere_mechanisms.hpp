// Rolling mechanisms of spheres. None larger than two-contact spheres (increment/two_contact_spheres.hpp)
// were observed, so all functions are empty.
#pragma once

#include "equilibrium/rolling_mechanisms.hpp"

namespace grainlaw::core {

template <>
class RollingMechanisms<3> {
 public:
  static bool possible(const Problem<3>& /*problem*/) { return false; }
  void find(const Increment<3>& /*increment*/, std::span<const TouchingContact<3>> /*touching*/) {}
  void regularise(const Increment<3>& /*increment*/, Stiffness<3>& /*stiffness*/) const {}
  void see(const Increment<3>& /*increment*/, std::span<const double> /*step*/, double /*least*/) {}
  void forget(const Increment<3>& /*increment*/) {}
  bool rotate(Increment<3>& /*increment*/, double /*least*/) { return false; }
};

}  // namespace grainlaw::core

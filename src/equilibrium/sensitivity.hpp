// Derivatives of the equilibrium by the deformation gradient, carried through sub-increments.
#pragma once

#include "contact/frictional.hpp"
#include "equilibrium/increment.hpp"
#include "equilibrium/stiffness.hpp"

#include <array>
#include <span>
#include <vector>

namespace grainlaw {

// Column k of everything is the derivative by the k-th component (row-major) of the F to be reached
// at the end of the increment; a sub-increment ends at a share of the way, linear in F.
class Sensitivity {
 public:
  void reset() { carried_ = false; }

  // Solve K dz = dr/dF at a converged sub-increment that ends at `share` and began at
  // `start_share`. False when the stiffness is singular.
  bool solve(Increment& increment, double share, double start_share, Stiffness& stiffness);

  // Keep what the next sub-increment's history depends on; call before
  // Increment::advance_history().
  void carry(const Increment& increment);

  // Change of the force on j (x, y) and of the branch (x, y) of contact c, for column k.
  struct Change {
    double force_x, force_y, branch_x, branch_y, tangential_force;
  };
  [[nodiscard]] Change change(const Increment& increment, std::size_t c, const ContactPoint& point,
                              std::size_t k) const;

 private:
  void start_of_history(const Increment& increment, double start_share);

  using Columns = std::array<std::vector<double>, 4>;
  double share_ = 1;
  Columns motion_;  // nodes, component-major
  bool carried_ = false;
  Columns carried_motion_;                            // at the start of the history
  std::vector<std::array<double, 4>> carried_force_;  // per contact of increment.history
  std::vector<std::array<double, 4>> start_turn_;     // per listed contact
  std::vector<std::array<double, 4>> start_force_;
  Columns right_;
};

}  // namespace grainlaw

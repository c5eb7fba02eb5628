// Derivatives of the equilibrium by the deformation gradient, carried through sub-increments.
#pragma once

#include "increment/increment.hpp"
#include "tangent/bordered_system.hpp"
#include "tangent/contact_change.hpp"
#include "tangent/drag_change.hpp"
#include "tangent/stiffness.hpp"

#include <vector>

namespace grainlaw::core {

// Lane k of every register is the derivative by the k-th component (row-major) of the F to be reached
// at the end of the increment; a sub-increment ends at a share of the way, linear in F.
template <int D>
class Sensitivity {
 public:
  void reset() {
    carried_ = false;
    by_chance_ = false;
    drag_.reset();
  }

  // Solve K dz = dr/dF at a converged sub-increment that ends at `share` and began at
  // `start_share`. False when the stiffness is singular.
  bool solve(Increment<D>& increment, double share, double start_share, Stiffness<D>& stiffness);

  // Keep what the next sub-increment's history depends on; call before
  // Increment::continue_history().
  void carry(const Increment<D>& increment);
  // Where a part with drag ends.
  void carry_drag(const Increment<D>& increment) { drag_.carry(increment, motion_); }
  // The same where no contact carries, at a share of the way.
  void carry_free(const Increment<D>& increment, double share);

  // Whether since reset() a place hung on one that is left to chance, which has no derivative.
  [[nodiscard]] bool by_chance() const { return by_chance_; }

  // Of F, at the end.
  [[nodiscard]] const DeformationChange<D>& deformation_change() const { return change_; }
  // Of a contact that touches.
  [[nodiscard]] const ContactChange<D>& changes(std::size_t c) const {
    return changes_[static_cast<std::size_t>(place_[c])];
  }

 private:
  bool complete(Increment<D>& increment, const HistoryChange<D>& history, Stiffness<D>& stiffness);
  void carry_motion(const Increment<D>& increment);

  DeformationChange<D> change_{}, carried_change_{};  // of F; found components depend on the others
  BorderedSystem border_;
  HistoryDerivatives<D> history_;
  DragDerivatives<D> drag_;
  std::vector<ByDeformation<D>> motion_, right_;  // per node and component
  std::vector<ByDeformation<D>> carried_motion_;  // at the start of the history
  std::vector<ContactChange<D>> changes_;         // per touching contact
  std::vector<ByDeformation<D>> moment_changes_;  // of laws with moments
  std::vector<std::int32_t> place_;  // of a listed contact among the touching, -1 when open
  std::vector<unsigned char> held_;  // as Increment::find_held tells
  bool carried_ = false;
  bool by_chance_ = false;
};

}  // namespace grainlaw::core

// Derivatives of the equilibrium by F, carried through sub-increments. @formula sensitivity
#pragma once

#include "increment/increment.hpp"
#include "tangent/bordered_system.hpp"
#include "tangent/contact_change.hpp"
#include "tangent/drag_change.hpp"
#include "tangent/stiffness.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

// Lane k is the derivative by the k-th component (row-major) of F at the end of the increment. F of
// a sub-increment is linear in its share.
template <int D>
class Sensitivity {
 public:
  void reset() {
    carried_ = false;
    arbitrary_ = false;
    drag_.reset();
  }

  // Solves K dz = dr/dF at a converged sub-increment from `start_share` to `share`. Returns false
  // if the stiffness is singular.
  bool solve(Increment<D>& increment, double share, double start_share, Stiffness<D>& stiffness);

  // Carries what the history of the next sub-increment depends on; comes before
  // Increment::continue_history().
  void carry(const Increment<D>& increment);
  // Carries the derivatives of the drag at the end of a part.
  void carry_drag(const Increment<D>& increment) { drag_.carry(increment, motion_); }
  // Carries the derivatives through a sub-increment without load-bearing contacts that ends at
  // `share`.
  void carry_free(const Increment<D>& increment, double share);

  // True if a position depended on an arbitrary one since reset(), so that no derivative exists.
  [[nodiscard]] bool arbitrary() const { return arbitrary_; }

  // Changes of the fluctuations at the end, per node and component.
  [[nodiscard]] std::span<const ByDeformation<D>> motion() const { return motion_; }
  // Change of F at the end.
  [[nodiscard]] const DeformationChange<D>& deformation_change() const { return change_; }
  // Change of a touching contact.
  [[nodiscard]] const ContactChange<D>& changes(std::size_t c) const {
    return changes_[static_cast<std::size_t>(index_[c])];
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
  std::vector<ByDeformation<D>> moment_changes_;  // for laws with moments
  std::vector<std::int32_t> index_;       // index of a listed contact among the touching; -1: open
  std::vector<unsigned char> supported_;  // see Increment::find_supported
  bool carried_ = false;
  bool arbitrary_ = false;
};

}  // namespace grainlaw::core

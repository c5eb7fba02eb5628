// Derivatives of the equilibrium by the deformation gradient, carried through sub-increments.
#pragma once

#include "contact/contact_point.hpp"
#include "increment/increment.hpp"
#include "tangent/bordered_system.hpp"
#include "tangent/contact_change.hpp"
#include "tangent/stiffness.hpp"

#include <array>
#include <span>
#include <vector>

namespace grainlaw {

// Lane k of every quad is the derivative by the k-th component (row-major) of the F to be reached
// at the end of the increment; a sub-increment ends at a share of the way, linear in F.
class Sensitivity {
 public:
  void reset() { carried_ = false; }

  // Solve K dz = dr/dF at a converged sub-increment that ends at `share` and began at
  // `start_share`. False when the stiffness is singular.
  bool solve(Increment& increment, double share, double start_share, Stiffness& stiffness);

  // Keep what the next sub-increment's history depends on; call before
  // Increment::continue_history().
  void carry(const Increment& increment);
  // The same where no contact carries, at a share of the way.
  void carry_free(const Increment& increment, double share);

  // Of a contact that touches.
  using Changes = ContactChange;
  [[nodiscard]] const Changes& changes(std::size_t c) const {
    return changes_[static_cast<std::size_t>(place_[c])];
  }
  // The same of column k.
  struct Change {
    double force_x, force_y, branch_x, branch_y, tangential_force;
  };
  [[nodiscard]] Change change(const Increment&, std::size_t c, const ContactPoint&,
                              std::size_t k) const {
    const Changes& all = changes(c);
    return {all.force_x.lane[k], all.force_y.lane[k], all.branch_x.lane[k], all.branch_y.lane[k],
            all.tangential_force.lane[k]};
  }

 private:
  void start_of_history(const Increment& increment, double start_share);
  bool complete(Increment& increment, const HistoryChange& history, Stiffness& stiffness);
  void carry_motion(const Increment& increment);
  // Hertz-Mindlin: the springs follow the overlap.
  void rescale_start(const Increment& increment);

  DeformationChange change_{}, carried_change_{};  // of F; found components depend on the others
  BorderedSystem border_;
  std::vector<Quad> motion_, right_;  // per node and component
  std::vector<Changes> changes_;      // per touching contact
  std::vector<std::int32_t> place_;   // of a listed contact among them, -1 when open
  bool carried_ = false;
  std::vector<Quad> carried_motion_;            // at the start of the history
  std::vector<Quad> carried_force_;             // per contact of increment.history
  std::vector<Quad> start_turn_, start_force_;  // per listed contact
  std::vector<unsigned char> held_;             // as Increment::find_held tells
  std::vector<Quad> start_overlap_;             // of Hertz-Mindlin: per listed contact
  // Of laws with moments: per touching contact, per contact of the history, per listed contact.
  std::vector<Quad> moment_changes_, carried_moment_, start_moment_, start_spin_;
};

}  // namespace grainlaw

// One increment of deformation being solved: motion, contacts, masses and forces. Everything the solvers
// share, and all their memory; sized once, reused from call to call by one thread.
#pragma once

#include "contact/contact_sides.hpp"
#include "increment/candidates.hpp"
#include "increment/force_scale.hpp"
#include "increment/free_spins.hpp"
#include "increment/losses.hpp"
#include "increment/masses.hpp"
#include "increment/motion.hpp"
#include "increment/touching_history.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace grainlaw::core {

// Whether friction starts from where the increment began or from the last evaluation.
enum class History { committed, advancing };

// What finding an equilibrium takes.
struct Cost {
  long relaxation_steps = 0;
  long servo_corrections = 0;
  int factorisations = 0;

  void add(const Cost& other) {
    relaxation_steps += other.relaxation_steps;
    servo_corrections += other.servo_corrections;
    factorisations += other.factorisations;
  }
};

// Solvers move the motion and count what they do; all else follows by the functions here.
template <int D>
class Increment {
 public:
  Cost cost;

  // Start from a configuration; `deformation` is the F to be reached without rotation, the guess is the
  // affine image. Rotations are counted from here.
  void begin(const Problem<D>& problem, const Configuration<D>& from, const Tensor<D>& deformation);
  // Reach for another F from the present history; the guess moves affinely with it.
  void deform(const Tensor<D>& deformation);
  // A number that no other increment of this process has: what was cached for it serves it alone.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  // Relist neighbours when a particle may have come near one that is not listed; whether it did.
  bool keep_neighbours();

  // Forces at the present coordinates, and the residual.
  void update_forces(History history = History::committed);
  // Of the present records: forces on nodes, reduced, and no residual is made of them; those of contacts
  // alone; forces on nodes before they are reduced.
  void find_forces(History history);
  void find_contact_forces();
  void sum_forces(std::span<ForceRecord<D>> forces);

  // Of spheres whose contacts leave spins free: from the next update_forces() on the residual holds these
  // to their rule, or no longer. Whether there is anything to hold.
  bool hold_free_spins();
  void release_free_spins() { holds_spins_ = false; }
  // At the present coordinates. What would hold them, as a residual is measured; 0 where there are none.
  double find_free_spins();
  [[nodiscard]] const auto& free_spins() const { return free_spins_; }

  // Of the present coordinates, with the scale of forces; of the present records, for records alone;
  // the scale alone, while the sides keep masses of their own.
  void refresh_masses();
  void sum_masses();
  void look(ContactSides<D>& sides);

  // Largest residual force (moment / R) of update_forces over the scale of forces [-]; infinite when no
  // contact is left or a number is not finite.
  [[nodiscard]] double residual_norm() const;

  // Make the present coordinates the start of the history; sums up the dissipated energy.
  void advance_history();
  // The same on the way through an increment, where the answer must not depend on what equilibrium
  // leaves open: nodes that nothing holds start where the deformation carries their last start, and
  // the mean fluctuation of those that are held.
  void continue_history();
  // Whether a contact that carries, or the boundary, holds a node: fixed_bit() of each direction.
  void find_held(std::vector<unsigned char>& held) const;

  // As the motion's, with its losses; before the first part of an increment, where that begins.
  void find_first_drag();
  void begin_drag(const DragStart<D>& how, std::span<const double> last_move, bool as_expected) {
    motion_.begin_drag(how, masses_.least(), last_move, as_expected);
  }
  void end_drag(std::vector<double>& move) { losses_.drag(motion_.end_drag(move)); }

  // Break bonds that are beyond their strength here, and the history starts anew from here; false
  // when none is. The worst break first, with all that exceed the strength by at least half as
  // much: the others may be relieved, and equal bonds break together.
  bool break_bonds();
  // Whether break_bonds() would.
  [[nodiscard]] bool overloads_bonds() const { return worst_bond() >= 1; }

  // Reference branch of a listed contact for a space bound to axes: X'_j - X'_i [m].
  [[nodiscard]] Vec<D> fixed_branch(std::size_t c) const {
    return motion_.fixed_branch(contacts_.i[c], contacts_.j[c]);
  }
  // Of a listed contact, x_j - x_i [m].
  [[nodiscard]] Vec<D> branch(std::size_t c) const;
  // Overlap of a listed contact, negative across a gap [m].
  [[nodiscard]] double overlap(std::size_t c) const;
  // Whether it is open by more than rounding, without a root.
  [[nodiscard]] bool surely_open(std::size_t c) const {
    constexpr double more_than_rounding = 1 + 1e-9;
    const double rest = more_than_rounding * contacts_.rest_of(c);
    return branch_square(c) > rest * rest && !contacts_.bonded(c);
  }
  // Whether a contact counts. Rattlers touch their cage with forces of about the residual, or not,
  // by chance; ten times as much is no chance.
  [[nodiscard]] bool carries(std::size_t c) const;
  // Whether any contact counts.
  [[nodiscard]] bool bears() const;
  // From here to the next F no contact counts but a bond, whatever is left of its force.
  void release_contacts() { released_ = true; }

  // Whether the boundary lost what it is to carry a uniform stress with: next to no force is left,
  // or a boundary particle has no contact.
  [[nodiscard]] bool collapsed();
  // Whether it did, or no contact is left.
  [[nodiscard]] bool lost() { return scale_.touching() == 0 || collapsed(); }
  // Whether found components of F went further than an increment goes: nothing carries the stress.
  [[nodiscard]] bool runs_away() const;
  // Of those under uniform stress, the first without a contact; -1: none.
  [[nodiscard]] int released_particle();

  // Put contacts, coordinates and dissipation into `to`, rotations added to those of `from`.
  void export_to(const Configuration<D>& from, Configuration<D>& to) const;

  [[nodiscard]] const Problem<D>& problem() const { return *problem_; }
  [[nodiscard]] Motion<D>& motion() { return motion_; }
  [[nodiscard]] const Motion<D>& motion() const { return motion_; }
  [[nodiscard]] const ContactList<D>& contacts() const { return contacts_; }
  // Of the listed contacts.
  [[nodiscard]] const std::vector<NeighbourPair<D>>& pairs() const { return candidates_.pairs(); }
  [[nodiscard]] const TouchingHistory<D>& history() const { return history_; }
  [[nodiscard]] const Masses<D>& masses() const { return masses_; }
  [[nodiscard]] const ForceScale& scale() const { return scale_; }
  [[nodiscard]] const Losses& losses() const { return losses_; }
  // On nodes, and rows of F where some of it is found.
  [[nodiscard]] std::span<const ForceRecord<D>> forces() const { return forces_; }
  // Of the unknowns, component-major [N, N m].
  [[nodiscard]] std::span<const double> residual() const { return residual_; }

 private:
  static constexpr std::size_t dim = D;
  static constexpr std::size_t spins = Dimension<D>::spins;

  void list_contacts();
  void build_list();
  void advance_contacts_and_history();
  void reduce(std::span<ForceRecord<D>> forces) const;
  void take_found_stress(std::span<ForceRecord<D>> forces) const;
  [[nodiscard]] double branch_square(std::size_t c) const { return square<D>(branch(c)); }
  [[nodiscard]] double bond_load(std::size_t c) const;
  [[nodiscard]] double worst_bond() const;
  [[nodiscard]] double potential_energy() const;

  const Problem<D>* problem_ = nullptr;
  std::uint64_t epoch_ = 0;
  Motion<D> motion_;
  Candidates<D> candidates_;
  TouchingHistory<D> history_;
  ContactList<D> contacts_;
  Masses<D> masses_;
  ForceScale scale_;
  Losses losses_;
  std::vector<ForceRecord<D>> forces_;
  std::vector<double> residual_;
  std::vector<unsigned char> held_;  // of nodes, as found last
  bool released_ = false;
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<D == 3, FreeSpins, Nothing> free_spins_;
  bool holds_spins_ = false;
};

template <int D>
Vec<D> Increment<D>::branch(std::size_t c) const {
  const auto n = problem_->particles();
  const auto p = static_cast<std::size_t>(contacts_.i[c]);
  const auto q = static_cast<std::size_t>(contacts_.j[c]);
  Vec<D> l{};
  for (std::size_t k = 0; k < dim; ++k) {
    const double* x = motion_.coordinates().data() + k * n;
    l[k] = x[q] - x[p] + contacts_.offset[k][c];
  }
  return l;
}

}  // namespace grainlaw::core

// Increment of deformation being solved: motion, contacts, masses and forces. It owns all that the
// solvers share and all their memory. Buffers are sized once and reused by one thread.
#pragma once

#include "contact/half_contacts.hpp"
#include "increment/candidates.hpp"
#include "increment/force_scale.hpp"
#include "increment/losses.hpp"
#include "increment/masses.hpp"
#include "increment/motion.hpp"
#include "increment/touching_history.hpp"
#include "increment/two_contact_spheres.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace grainlaw::core {

// Reference of friction: the start of the increment, or the last evaluation.
enum class History { committed, advancing };

// Work that an equilibrium takes.
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

// Solvers change the motion and count their work; the functions here derive all else.
template <int D>
class Increment {
 public:
  Cost cost;

  // Starts from a configuration with the affine guess. `deformation` is the F to reach, without
  // rotation. Rotations count from here.
  void begin(const Problem<D>& problem, const Configuration<D>& from, const Tensor<D>& deformation);
  // Sets another F to reach with the present history; the guess moves affinely.
  void deform(const Tensor<D>& deformation);
  // Returns a number that no other increment of this process has, so that caches can tell it.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  // Relists neighbours if a particle may have come near one that is not listed. Returns whether it
  // did.
  bool keep_neighbours();

  // Computes forces at the present coordinates, and the residual.
  void update_forces(History history = History::committed);
  // Computes reduced forces on nodes from the present records, without the residual.
  void find_forces(History history);
  // Computes the forces of the contacts from the present records.
  void find_contact_forces();
  // Computes forces on nodes, drag included, before reduction.
  void sum_forces(std::span<ForceRecord<D>> forces);

  // Adds the springs of two-contact spheres to the residual from the next update_forces() on.
  // Returns whether the law needs them.
  bool add_chord_springs();
  void remove_chord_springs() { has_chord_springs_ = false; }
  // Finds the two-contact spheres at the present coordinates. Returns the largest force of their
  // springs over the force scale [-].
  double find_two_contact_spheres();
  [[nodiscard]] const auto& two_contact_spheres() const { return two_contact_spheres_; }

  // Updates masses and force scale at the present coordinates.
  void refresh_masses();
  // Updates masses and force scale from the present records, for the records alone.
  void sum_masses();
  // Relinearises half contacts around the present records and updates the force scale; they have
  // masses of their own.
  void relinearise(HalfContacts<D>& half_contacts);

  // Largest residual force (moment / R) of update_forces over the force scale [-]. Infinite without
  // contacts or if a number is not finite.
  [[nodiscard]] double residual_norm() const;

  // Makes the present coordinates the start of the history and sums up the dissipated energy.
  void advance_history();
  // Makes the present coordinates the start of the history within an increment. Unsupported nodes
  // start at the affine image of their last start, plus the mean fluctuation of the supported ones.
  // The answer then does not depend on what equilibrium leaves open.
  void continue_history();
  // Finds the directions in which contacts or the boundary support a node, as fixed_bit() of each.
  void find_supported(std::vector<unsigned char>& supported) const;

  // Computes the drag and the force scale at the start of an increment, before its first part
  // begins. Without stress there is no drag.
  void find_first_drag(bool stressed);
  void begin_drag(const DragStart<D>& how, std::span<const double> velocity, bool as_expected) {
    motion_.begin_drag(how, masses_.least(), velocity, as_expected);
  }
  void end_drag(std::vector<double>& velocity) { losses_.drag(motion_.end_drag(velocity)); }

  // Breaks overloaded bonds and restarts the history here; returns false if there is none. Breaks
  // the worst bond and all whose excess is at least half of its. Others may be relieved, and equal
  // bonds break together. @formula bond
  bool break_bonds();
  // True if break_bonds() would break one.
  [[nodiscard]] bool overloads_bonds() const { return worst_bond() >= 1; }

  // Reference branch X'_j - X'_i of a listed contact, for a space bound to axes [m].
  [[nodiscard]] Vec<D> fixed_branch(std::size_t c) const {
    return motion_.fixed_branch(contacts_.i[c], contacts_.j[c]);
  }
  // Branch x_j - x_i of a listed contact [m].
  [[nodiscard]] Vec<D> branch(std::size_t c) const;
  // Overlap of a listed contact, negative across a gap [m].
  [[nodiscard]] double overlap(std::size_t c) const;
  // True if the contact is open by more than rounding; needs no square root.
  [[nodiscard]] bool surely_open(std::size_t c) const {
    constexpr double more_than_rounding = 1 + 1e-9;
    const double rest = more_than_rounding * contacts_.rest_of(c);
    return branch_square(c) > rest * rest && !contacts_.bonded(c);
  }
  // True if the contact is load bearing. Rattlers touch their cage at random with forces of about
  // the residual, so ten times the scatter is required.
  [[nodiscard]] bool bears_load(std::size_t c) const;
  // True if any contact is load bearing.
  [[nodiscard]] bool loaded() const;
  // Makes all contacts but bonds ineffective until the next F, whatever their force.
  void release_contacts() { released_ = true; }

  // True if the boundary cannot support a uniform stress: forces are close to zero, or a boundary
  // particle has no contact.
  [[nodiscard]] bool collapsed();
  // True if the boundary collapsed or no contact is left.
  [[nodiscard]] bool lost() { return scale_.touching() == 0 || collapsed(); }
  // True if the found components of F changed too much: no contact supports the stress.
  [[nodiscard]] bool runs_away() const;
  // First particle under uniform stress without a contact; -1: none.
  [[nodiscard]] int released_particle();

  // Writes contacts, coordinates and dissipation to `to`, with rotations since F = I.
  void export_to(const Configuration<D>& from, Configuration<D>& to) const;

  [[nodiscard]] const Problem<D>& problem() const { return *problem_; }
  [[nodiscard]] Motion<D>& motion() { return motion_; }
  [[nodiscard]] const Motion<D>& motion() const { return motion_; }
  [[nodiscard]] const ContactList<D>& contacts() const { return contacts_; }
  // Neighbour pairs of the listed contacts.
  [[nodiscard]] const std::vector<NeighbourPair<D>>& pairs() const { return candidates_.pairs(); }
  [[nodiscard]] const TouchingHistory<D>& history() const { return history_; }
  [[nodiscard]] const Masses<D>& masses() const { return masses_; }
  [[nodiscard]] const ForceScale& scale() const { return scale_; }
  [[nodiscard]] const Losses& losses() const { return losses_; }
  // Forces on nodes [N], then on the rows of F where components are found.
  [[nodiscard]] std::span<const ForceRecord<D>> forces() const { return forces_; }
  // Residual of the unknowns, component-major [N, N m].
  [[nodiscard]] std::span<const double> residual() const { return residual_; }

 private:
  static constexpr std::size_t dim = D;
  static constexpr std::size_t spins = Dimension<D>::spins;

  void list_contacts();
  void build_list();
  void advance_contacts_and_history();
  void reduce(std::span<ForceRecord<D>> forces) const;
  void add_missing_stress(std::span<ForceRecord<D>> forces) const;
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
  std::vector<unsigned char> supported_;  // supported directions of nodes, as found last
  bool released_ = false;
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<D == 3, TwoContactSpheres, Nothing> two_contact_spheres_;
  bool has_chord_springs_ = false;
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

// Increment of deformation being solved: the balance of forces, and the history of the contacts.
// One thread uses it again and again.
#pragma once

#include "increment/candidates.hpp"
#include "increment/force_balance.hpp"
#include "increment/touching_history.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

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

// Solvers change the motion and count their work. contact_state.hpp says what its contacts do.
template <int D>
class Increment : public ForceBalance<D> {
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

  // Makes the present coordinates the start of the history and sums up the dissipated energy.
  void advance_history();
  // Makes the present coordinates the start of the history within an increment. Unsupported nodes
  // start at the affine image of their last start, plus the mean fluctuation of the supported ones.
  // The answer then does not depend on what equilibrium leaves open.
  void continue_history();

  // Computes the drag and the force scale at the start of an increment, before its first part
  // begins. Without stress there is no drag.
  void find_first_drag(bool stressed);
  void begin_drag(const DragStart<D>& how, std::span<const double> velocity, bool as_expected) {
    motion_.begin_drag(how, masses_.least(), velocity, as_expected);
  }
  // Work of drag so far, that of a part that has not ended included [J].
  [[nodiscard]] double dragged() { return losses_.dragged() + motion_.work_of_drag(); }
  void end_drag(std::vector<double>& velocity) { losses_.drag(motion_.end_drag(velocity)); }

  // Breaks overloaded bonds and restarts the history here; returns false if there is none. Breaks
  // the worst bond and all whose excess is at least half of its. Others may be relieved, and equal
  // bonds break together. @formula bond
  bool break_bonds();
  // True if break_bonds() would break one.
  [[nodiscard]] bool overloads_bonds() const { return worst_bond() >= 1; }

  // Makes all contacts but bonds ineffective until the next F, whatever their force.
  void release_contacts() { released_ = true; }
  [[nodiscard]] bool released() const { return released_; }
  // First particle under uniform stress without a contact; -1: none.
  [[nodiscard]] int released_particle();
  // True if the found components of F changed too much: no contact supports the stress.
  [[nodiscard]] bool runs_away() const;

  // Writes contacts, coordinates and dissipation to `to`, with rotations since F = I.
  void export_to(const Configuration<D>& from, Configuration<D>& to) const;

  // Neighbour pairs of the listed contacts.
  [[nodiscard]] const std::vector<NeighbourPair<D>>& pairs() const { return candidates_.pairs(); }
  [[nodiscard]] const TouchingHistory<D>& history() const { return history_; }
  [[nodiscard]] const Losses& losses() const { return losses_; }

 private:
  using Balance = ForceBalance<D>;
  using Balance::contacts_;
  using Balance::forces_;
  using Balance::losses_;
  using Balance::masses_;
  using Balance::motion_;
  using Balance::problem_;
  using Balance::scale_;

  void list_contacts();
  void build_list();
  void advance_contacts_and_history();
  [[nodiscard]] double bond_load(std::size_t c) const;
  [[nodiscard]] double worst_bond() const;
  [[nodiscard]] double potential_energy() const;

  std::uint64_t epoch_ = 0;
  Candidates<D> candidates_;
  TouchingHistory<D> history_;
  std::vector<unsigned char> supported_;  // supported directions of nodes, as found last
  bool released_ = false;
};

}  // namespace grainlaw::core

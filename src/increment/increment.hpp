// One increment of deformation being solved: unknowns, contacts, forces and residuals. Everything
// the solvers share, and all their memory; sized once, reused from call to call by one thread.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/contact_list.hpp"
#include "frame/average_masses.hpp"
#include "increment/configuration.hpp"
#include "increment/problem.hpp"
#include "increment/turns.hpp"
#include "packing/neighbours.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

template <int D>
class Increment {
 public:
  static constexpr std::size_t dim = D;
  static constexpr std::size_t spins = Dimension<D>::spins;

  // Start from a configuration; `deformation` is the F to be reached without rotation, the guess is the
  // affine image. Rotations are counted from here.
  void begin(const Problem<D>& problem, const Configuration<D>& from, const Tensor<D>& deformation);

  // Reach for another F from the present history; the guess moves affinely with it.
  void deform(const Tensor<D>& deformation);

  // Forces at the present coordinates, and the reduced residual.
  void update_forces();
  // The same with the friction history advanced to here.
  void update_forces_advancing();

  // Mean normal force, and pseudo-masses of the nodes: tuned::mass_factor x the stiffness of the touching
  // contacts, never below one contact's worth (mechanics of the relaxation: unit pseudo-time step).
  void refresh_masses();

  // The same from the records and for the records alone: the mass of the roll R theta is I / R^2.
  void sum_masses();
  // One contact's worth.
  [[nodiscard]] std::span<const LeastMass<D>> least_masses() const { return least_masses_; }

  // Largest residual force (moment / R) of update_forces over max(mean normal force, floor) [-];
  // infinite when no contact is left or a number is not finite.
  [[nodiscard]] double residual_norm() const;

  // What the rounding of coordinates leaves of a residual at worst [N], and relative [-]: no
  // tolerance below it can be met.
  [[nodiscard]] double rounding_force() const { return rounding_force_; }
  [[nodiscard]] double rounding_residual() const {
    return touching > 0 ? rounding_force_ / relative_scale() : 0;
  }

  // Move every particle by factor x its node's step (component-major over nodes).
  void move(std::span<const double> step, double factor = 1);

  // Make the present coordinates the start of the history; sums up the dissipated energy.
  void advance_history();
  // The same on the way through an increment, where the answer must not depend on what equilibrium
  // leaves open: nodes that nothing holds start where the deformation carries their last start, and
  // the mean fluctuation of those that are held.
  void continue_history();
  // Whether a contact that carries, or the boundary, holds a node: fixed_bit() of each direction.
  void find_held(std::vector<unsigned char>& held) const;

  // Break bonds that are beyond their strength here, and the history starts anew from here; false
  // when none is. The worst break first, with all that exceed the strength by at least half as
  // much: the others may be relieved, and equal bonds break together.
  bool break_bonds();
  // Whether break_bonds() would.
  [[nodiscard]] bool overloads_bonds() const { return worst_bond() >= 1; }

  // Overlap of a listed contact, negative across a gap [m].
  [[nodiscard]] double overlap(std::size_t c) const;
  // Whether it is open by more than rounding, without a root.
  [[nodiscard]] bool surely_open(std::size_t c) const {
    constexpr double more_than_rounding = 1 + 1e-9;
    const double rest = more_than_rounding * contacts.rest_of(c);
    return branch_square(c) > rest * rest && !contacts.bonded(c);
  }
  // Square of the length of its branch [m^2].
  [[nodiscard]] double branch_square(std::size_t c) const {
    const auto n = particles();
    const auto p = static_cast<std::size_t>(contacts.i[c]);
    const auto q = static_cast<std::size_t>(contacts.j[c]);
    Vec<D> l{};
    for (std::size_t k = 0; k < dim; ++k) {
      const double* x = coordinates.data() + k * n;
      l[k] = x[q] - x[p] + contacts.offset[k][c];
    }
    return square<D>(l);
  }

  // Forces differ by this much by chance: tolerance and rounding [N].
  [[nodiscard]] double chance_force() const;

  // Whether a contact counts. Rattlers touch their cage with forces of about the residual, or not,
  // by chance; ten times as much is no chance.
  [[nodiscard]] bool carries(std::size_t c) const;

  // Whether any contact counts.
  [[nodiscard]] bool bears() const;

  // From here to the next F no contact counts but a bond, whatever is left of its force.
  void release_contacts() { released_ = true; }

  // Put contacts, coordinates and dissipation into `to`, rotations added to those of `from`.
  void export_to(const Configuration<D>& from, Configuration<D>& to) const;

  // Relist neighbours when a particle may have come near one that is not listed; whether it did.
  bool keep_neighbours();

  // From forces on nodes to the residual, in place: nothing on what is prescribed, nothing that the
  // average constraint carries (with the present masses), and behind the nodes a record for every row
  // of F with what the prescribed stresses leave to move it.
  void reduce(std::span<ForceRecord<D>> residual) const;

  // Change F by the record behind the nodes for every row, times scale(), and the records of
  // particles with it.
  void change_deformation(const double* rows, std::vector<ParticleRecord<D>>& moved);

  // Components of F that are found count as lengths: F times this [m], so that their residual is a
  // force, the missing stress on the cross section of one particle.
  [[nodiscard]] double deformation_scale() const { return deformation_scale_; }

  [[nodiscard]] double mean_branch() const { return mean_branch_; }  // 2 R [m]

  // Reference branch of a listed contact for a space bound to axes: X'_j - X'_i [m].
  [[nodiscard]] Vec<D> fixed_branch(std::size_t c) const;

  // Whether the boundary lost what it is to carry a uniform stress with: next to no force is left,
  // or a boundary particle has no contact.
  [[nodiscard]] bool collapsed();
  // Of those under uniform stress, the first without a contact; -1: none.
  [[nodiscard]] int released_particle();

  // Where the history starts anew, spheres count their rotations from here.
  void restart_turns();

  // Coordinates to the records that contacts read, and back.
  void load_records();
  void store_records();

  [[nodiscard]] std::span<const double> residual() const { return node_residual; }
  [[nodiscard]] std::size_t particles() const { return problem->packing->size(); }
  [[nodiscard]] std::size_t nodes() const { return problem->space->nodes; }
  // Components of nodes, and after them those of F where some are found.
  [[nodiscard]] std::size_t unknowns() const {
    return node_unknowns() + (problem->space->finds_deformation ? squared<D> : 0);
  }
  [[nodiscard]] std::size_t node_unknowns() const {
    return nodes() * static_cast<std::size_t>(problem->components());
  }
  [[nodiscard]] double relative_scale() const;
  // kn between equal particles, mean over the nodes [N/m].
  [[nodiscard]] double mean_stiffness() const;

  const Problem<D>* problem = nullptr;
  Tensor<D> deformation{};                 // F being solved, free of the increment's rotation
  Tensor<D> start_deformation{};           // where the history starts
  Tensor<D> committed_deformation{};       // where the increment began
  Tensor<D> cell{};                        // F H0, zero on a frame [m]
  std::vector<double> coordinates;         // component-major: positions, rotation increments
  std::vector<double> start;               // coordinates where the history starts
  std::vector<ContactHistory<D>> history;  // touching contacts there
  std::vector<double> history_moments, history_gaps;  // of them, as in Configuration
  std::vector<ParticleRecord<D>> records;             // the coordinates as contacts read them
  std::vector<ForceRecord<D>> forces;       // on nodes, and rows of F where some of it is found
  std::vector<double> node_residual;        // reduced, component-major [N, N m]
  std::vector<double> mass;                 // of the unknowns
  std::vector<MassRecord<D>> mass_records;  // the same as records
  std::vector<double> node_radius;          // [m]
  ContactList<D> contacts;
  std::vector<NeighbourPair<D>> pairs;
  std::vector<double> pair_weights;
  double mean_force = 0;  // [N]
  int touching = 0;
  double dissipated = 0;    // since begin [J]
  double broken_bonds = 0;  // since begin, with their weights [-]
  long relaxation_steps = 0;
  long servo_corrections = 0;
  int factorisations = 0;

 private:
  [[nodiscard]] Tensor<D> cell_at(const Tensor<D>& f) const;
  void list_neighbours();
  void advance_contacts_and_history();
  void carry_start();
  void list_bonded_pairs();
  [[nodiscard]] double bond_load(std::size_t c) const;
  [[nodiscard]] double worst_bond() const;
  void build_list();
  void project();
  void carry_affinely(const Tensor<D>& from, const Tensor<D>& to,
                      std::vector<double>& positions) const;
  [[nodiscard]] double affine_place(std::size_t p, std::size_t direction) const;
  void place_fixed();
  // How far a packing that nothing holds has moved as a whole [m].
  [[nodiscard]] Vec<D> drift() const;
  void find_least_masses();
  void find_average_masses();
  void find_deformation_masses();
  [[nodiscard]] double potential_energy() const;

  std::vector<NeighbourPair<D>> merged_pairs_;
  bool released_ = false;
  // Of the state in which bonds broke last: until the next, what the energy falls by is lost.
  bool after_break_ = false;
  double break_energy_ = 0, break_dissipated_ = 0;  // [J]
  std::vector<LeastMass<D>> least_masses_;
  std::vector<StiffnessRecord<D>> stiffness_;  // summed over the contacts of nodes
  std::vector<double> listed_;                 // positions when the neighbours were listed
  double gap_ = 0;
  double rounding_force_ = 0;  // [N]
  double deformation_scale_ = 1;
  double mean_branch_ = 0;  // 2 R [m]
  AverageMasses average_masses_;
  std::vector<unsigned char> held_;  // of nodes, as found last
  std::vector<double> carried_start_;
  Turned<D> turned_;
  NeighbourSearch<D> search_;
};

}  // namespace grainlaw::core

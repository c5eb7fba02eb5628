// Motion of a specimen's particles (Liu's thesis, eq. 4.21): explicit integration with the contact
// laws of the library, without damping.
#pragma once

#include "contact/contact_list.hpp"
#include "dynamics/specimen.hpp"
#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace grainlaw::core {

// Energies of the specimen: work + stored at the start = kinetic + stored + dissipated.
struct WaveEnergy {
  double work = 0;        // by the right end since the start [J]
  double kinetic = 0;     // [J]
  double coherent = 0;    // kinetic energy of the mean motion of cross-sections [J]
  double stored = 0;      // in contacts [J]
  double dissipated = 0;  // by friction, broken bonds and damping [J]
};

// Damping of single grains that leaves waves alone. The velocity of each particle decays to the
// mean of its cross-section at this rate; momentum is conserved.
struct AgitationDamping {
  double rate = 0;   // [1/s]
  double slice = 0;  // width of cross-sections [m]
};

// Finite differences of first order, eqs. 4.18-4.20: accelerations from positions, velocities from
// accelerations, positions from velocities. They equal central differences with velocities half a
// step behind.
class WaveMotion {
 public:
  // Throws Error (BAD_ARGUMENT) when the time step [s] exceeds the limit of stability.
  WaveMotion(const WaveSpecimen& specimen, const ContactLaw& law, double time_step);

  // Advances one time step, after which the right end has this displacement [m]. Throws
  // Error (NOT_CONVERGED) for a position that is not finite.
  void step(double end_displacement);

  // Relaxes forces that the supports left unbalanced, before the first step. Throws
  // Error (NOT_CONVERGED) when that takes too long.
  void settle();
  void damp(const AgitationDamping& damping) { damping_ = damping; }

  [[nodiscard]] const WaveSpecimen& specimen() const { return *specimen_; }
  [[nodiscard]] double displacement(std::size_t p) const {  // in x, relative to rest [m]
    return particles_[p].x - rest_[p];
  }
  // Contact forces in y on every particle, copies counted separately [N].
  [[nodiscard]] std::vector<double> vertical_forces() const;
  // Energies, with cross-sections `slice` wide [m].
  [[nodiscard]] WaveEnergy energy(double slice) const;
  [[nodiscard]] int touching() const;

 private:
  // Mean velocities of cross-sections, and the cross-section of each node.
  struct Slices {
    std::vector<std::array<double, 2>> velocity;
    std::vector<double> mass;
    std::vector<std::uint32_t> of;  // nodes
  };
  void list_contacts();
  void keep_list();
  void find_forces();
  void break_bonds();
  void damp_agitation();
  void move_particles();
  [[nodiscard]] double force_on_right_end() const;
  [[nodiscard]] std::size_t node(std::size_t p) const {
    return static_cast<std::size_t>(specimen_->node[p]);
  }
  // Lower bound of the largest stable time step [s]: 2 over a Gershgorin bound of the frequencies.
  void find_largest_time_step();
  void find_slices(double width, Slices& slices) const;
  void add_to_slices(double half_step, Slices& slices) const;
  [[nodiscard]] std::vector<double> coordinates() const;

  const WaveSpecimen* specimen_;
  ContactLaw law_;
  double time_step_;
  AgitationDamping damping_;
  Slices slices_;  // cross-sections of the damping
  double gap_;     // largest gap of listed neighbours [m]
  double end_ = 0;
  double work_ = 0, dissipated_ = 0, largest_time_step_ = 0;
  std::vector<ParticleRecord<2>> particles_;
  // Forces, velocities and inverse masses of nodes; `roll` is R theta.
  std::vector<ForceRecord<2>> forces_, velocity_, inverse_mass_;
  std::vector<double> mass_;              // of the nodes [kg]
  std::vector<std::size_t> particle_of_;  // one particle of each node
  std::vector<std::array<double, 2>> listed_;
  std::vector<double> rest_;  // x at rest, before the wave [m]
  std::vector<std::size_t> right_;
  // Contact history from which the next list starts.
  std::vector<ContactHistory<2>> history_;
  std::vector<double> moments_, gaps_;
  NeighbourSearch<2> search_;
  std::vector<NeighbourPair<2>> pairs_;
  std::vector<double> weights_;
  ContactList<2> list_;
};

}  // namespace grainlaw::core

// The particles of a specimen in motion (Liu's thesis, eq. 4.21): explicit integration with the
// contact laws of the library, without damping.
#pragma once

#include "contact/contact_list.hpp"
#include "dns/wave_specimen.hpp"
#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace verification {

// Energies of the specimen; work + stored at the start = kinetic + stored + dissipated.
struct WaveEnergy {
  double work = 0;        // done by the right end since the start [J]
  double kinetic = 0;     // [J]
  double coherent = 0;    // of it, in the mean motion of cross-sections [J]
  double stored = 0;      // in contacts [J]
  double dissipated = 0;  // by friction and broken bonds [J]
};

// First-order finite differences as in eqs. 4.18-4.20, which are central ones with velocities half a
// step behind: accelerations from the positions, velocities from the accelerations, positions from
// the velocities.
class WaveMotion {
 public:
  // Throws InputError when the time step [s] is beyond the limit of stability.
  WaveMotion(const WaveSpecimen& specimen, const grainlaw::ContactLaw& law, double time_step);

  // One time step; at its end the right end stands at this displacement [m]. Throws
  // ComputationError when positions are lost.
  void step(double end_displacement);

  [[nodiscard]] const WaveSpecimen& specimen() const { return *specimen_; }
  [[nodiscard]] double displacement(std::size_t p) const {  // in x [m]
    return particles_[p].x - specimen_->position[p];
  }
  // Sum of the contact forces on a particle [N].
  [[nodiscard]] const grainlaw::ForceRecord& force(std::size_t p) const { return forces_[p]; }
  // Cross-sections are `slice` wide [m].
  [[nodiscard]] WaveEnergy energy(double slice) const;
  [[nodiscard]] double broken_bonds() const { return broken_; }
  [[nodiscard]] int touching() const;
  // A bound of the largest stable time step [s]: 2 / the largest of the frequencies by Gershgorin.
  [[nodiscard]] double largest_time_step() const { return largest_time_step_; }

 private:
  void list_contacts();
  void keep_list();
  void find_forces();
  void break_bonds();
  void find_largest_time_step();
  [[nodiscard]] std::vector<double> coordinates() const;

  const WaveSpecimen* specimen_;
  grainlaw::ContactLaw law_;
  double time_step_;
  double gap_;  // neighbours are listed within it [m]
  double end_ = 0;
  double work_ = 0, dissipated_ = 0, broken_ = 0, largest_time_step_ = 0;
  std::vector<grainlaw::ParticleRecord> particles_;
  std::vector<grainlaw::ForceRecord> forces_, velocity_, inverse_mass_;  // roll: R theta
  std::vector<std::array<double, 2>> listed_;
  std::vector<std::size_t> right_;
  // What the next list starts from.
  std::vector<grainlaw::ContactHistory> history_;
  std::vector<double> moments_, gaps_;
  std::vector<int> node_;
  grainlaw::NeighbourSearch search_;
  std::vector<grainlaw::NeighbourPair> pairs_;
  std::vector<double> weights_;
  grainlaw::ContactList list_;
};

}  // namespace verification

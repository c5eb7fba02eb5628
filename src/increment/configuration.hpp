// Equilibrium of the representative volume: all that the next increment needs.
#pragma once

#include "contact/history.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

template <int D>
struct Configuration {
  Tensor<D> deformation{};  // F
  // Component-major: positions [m], then rotations since F = I in rotation_numbers per particle if
  // particles rotate.
  std::vector<double> coordinates;
  std::vector<ContactHistory<D>> contacts;  // touching contacts, ordered by (i, j, shift)
  Tensor<D> stress{};                       // first Piola-Kirchhoff stress P [Pa]
  double dissipated = 0;                    // by friction and broken bonds since F = I [J]
  std::vector<double> moments;    // on j, `spins` per contact; empty for laws without moments [N m]
  std::vector<double> bond_gaps;  // stress-free branch - (R_i + R_j), one per contact; empty unless
                                  // bonds span gaps [m]
  double broken_bonds = 0;        // since F = I, weighted as their contacts [-]
  // Velocity of the drag's masses, as positions [m] and rotation vectors [rad] per memory. With
  // inertia that of the particles' fluctuations, per s. Empty without both.
  std::vector<double> velocity;
  Tensor<D> strain_rate{};  // mean, of drag [1 / memory]
};

// True if no value is infinite or NaN.
inline bool all_finite(std::span<const double> values) {
  double zero = 0;
  for (const double value : values) zero += value - value;
  return zero == 0;
}
template <int D>
bool all_finite(const Configuration<D>& c) {
  const auto& contacts = c.contacts;
  return all_finite(c.deformation) && all_finite(c.coordinates) && all_finite(c.stress) &&
         std::isfinite(c.dissipated) && all_finite(c.moments) && all_finite(c.bond_gaps) &&
         all_finite(c.velocity) && all_finite(c.strain_rate) &&
         std::all_of(contacts.begin(), contacts.end(), [](const ContactHistory<D>& contact) {
           return all_finite(contact.tangential_force);
         });
}

// Angle or rotation vector [rad] of a rotation whose numbers are stored `apart` doubles from each
// other.
template <int D>
std::array<double, Dimension<D>::spins> rotation_of(const double* numbers, std::size_t apart) {
  if constexpr (D == 2) {
    return {numbers[0]};
  } else {
    const Vec<3> v{numbers[apart], numbers[2 * apart], numbers[3 * apart]};
    const double sine = length<3>(v);
    const double angle = 2 * std::atan2(sine, numbers[0]);
    const double scale = sine > 0 ? angle / sine : 2;
    return {scale * v[0], scale * v[1], scale * v[2]};
  }
}

// Appends zero rotations to the positions.
template <int D>
void append_zero_rotations(std::size_t particles, std::vector<double>& coordinates) {
  if constexpr (D == 3) coordinates.resize(coordinates.size() + particles, 1.0);
  coordinates.resize((D + Dimension<D>::rotation_numbers) * particles, 0.0);
}

}  // namespace grainlaw::core

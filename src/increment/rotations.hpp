// Rotations of particles: how steps add to them, and how a restarted history refers to them.
#pragma once

#include "contact/records.hpp"
#include "contact/sphere_point.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Rotates particles by factor x the spin of their node; both arrays are component-major.
template <int D>
void add_spins(const double* spin, std::size_t nodes, std::span<const int> node, double factor,
               double* rotation);

// Adds angles of discs, which the history keeps.
template <>
inline void add_spins<2>(const double* spin, std::size_t /*nodes*/, std::span<const int> node,
                         double factor, double* rotation) {
  for (std::size_t p = 0; p < node.size(); ++p) rotation[p] += factor * spin[node[p]];
}

// Composes Gibbs vectors of spheres: (w + theta + w x theta / 2) / (1 - w.theta / 4), with spin w
// after theta.
template <>
inline void add_spins<3>(const double* spin, std::size_t nodes, std::span<const int> node,
                         double factor, double* rotation) {
  const std::size_t n = node.size();
  for (std::size_t p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(node[p]);
    const Vec<3> w{factor * spin[q], factor * spin[nodes + q], factor * spin[2 * nodes + q]};
    const Vec<3> theta{rotation[p], rotation[n + p], rotation[2 * n + p]};
    const Vec<3> both = sum(sum(w, 1, theta), 0.5, cross(w, theta));
    const double scale = 1 / (1 - 0.25 * dot(w, theta));
    for (std::size_t k = 0; k < 3; ++k) rotation[k * n + p] = scale * both[k];
  }
}

// Rotation of particles between the start of the increment and the last restart of the history.
template <int D>
class RotationReference;

template <>
class RotationReference<2> {
 public:
  void reset(std::size_t /*particles*/, bool /*rotating*/) {}
  void restart(std::span<ParticleRecord<2>> /*records*/, double* /*rotation*/) {}
  // Adds the rotations of `from`, which makes them rotations since F = I.
  void export_to(std::size_t particles, const std::vector<double>& from,
                 std::vector<double>& coordinates) const {
    for (std::size_t k = 2 * particles; k < coordinates.size(); ++k) coordinates[k] += from[k];
  }
};

// Stores one unit quaternion per sphere.
template <>
class RotationReference<3> {
 public:
  void reset(std::size_t particles, bool rotating) {
    rotation_.assign(rotating ? particles : 0, Quaternion{});
  }
  void restart(std::span<ParticleRecord<3>> records, double* rotation) {
    const std::size_t n = rotation_.size();
    for (std::size_t p = 0; p < n; ++p) {
      const auto& record = records[p];
      const double inverse = 1 / record.radius;
      rotation_[p] = product(
          quaternion_of({inverse * record.eta_x, inverse * record.eta_y, inverse * record.eta_z}),
          rotation_[p]);
      for (std::size_t k = 0; k < 3; ++k) rotation[k * n + p] = 0;
      records[p].eta_x = records[p].eta_y = records[p].eta_z = 0;
      records[p].half = 0.5;
    }
  }
  void export_to(std::size_t particles, const std::vector<double>& from,
                 std::vector<double>& coordinates) const {
    const std::size_t n = particles;
    if (rotation_.empty()) return coordinates.resize(3 * n);
    coordinates.resize(7 * n);
    for (std::size_t p = 0; p < n; ++p) {
      const Quaternion before{from[3 * n + p], {from[4 * n + p], from[5 * n + p], from[6 * n + p]}};
      const Quaternion all =
          product(product(since(coordinates.data() + 3 * n, p), rotation_[p]), before);
      coordinates[3 * n + p] = all.s;
      for (std::size_t k = 0; k < 3; ++k) coordinates[(4 + k) * n + p] = all.v[k];
    }
  }

 private:
  [[nodiscard]] Quaternion since(const double* rotation, std::size_t p) const {
    const std::size_t n = rotation_.size();
    return quaternion_of({rotation[p], rotation[n + p], rotation[2 * n + p]});
  }

  std::vector<Quaternion> rotation_;
};

}  // namespace grainlaw::core

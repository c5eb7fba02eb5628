// Particles of a periodic cell that a given F(t) moves, by explicit steps that share no code with the
// library's: linear contacts with friction, masses and moments of inertia, discs as spheres in a plane.
#pragma once

#include "homogenise/measures.hpp"
#include "material/material.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

namespace grainlaw::core::moving_cell {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

inline Vector plus(const Vector& a, double factor, const Vector& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Stretches along the axes: lengths over those at the start, and their rates.
struct Stretch {
  Vector of{1, 1, 1}, rate{};
};

template <int D>
class MovingCell {
 public:
  explicit MovingCell(const Material<D>& material) : material_(material) {
    const Packing& packing = material.packing;
    const std::size_t n = packing.size();
    const auto& start = material.initial.coordinates;
    place_.resize(n), velocity_.resize(n), spin_.resize(n), force_.resize(n), moment_.resize(n);
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t k = 0; k < D; ++k) place_[p][k] = start[k * n + p];
      const double r = packing.radius[p];
      const double volume = D == 2 ? packing.thickness * std::numbers::pi * r * r
                                   : 4 * std::numbers::pi * r * r * r / 3;
      mass_.push_back(packing.density * volume);
    }
    for (std::size_t i = 0; i < D; ++i)
      for (std::size_t j = 0; j < D; ++j) cell_[i][j] = packing.cell[D * i + j];
    for (const auto& view : contact_views(material.problem(), material.initial)) {
      Vector force{};
      for (std::size_t k = 0; k < D; ++k) force[k] = view.tangential_force_vector()[k];
      springs_[key(view)] = force;
    }
    find_pairs();
    find_forces(Stretch{}, 0);
  }

  // One step to these stretches: velocities of the fluctuations by v' = f / m - L v, then places.
  void step(const Stretch& now, const Stretch& next, double dt) {
    for (std::size_t p = 0; p < place_.size(); ++p) {
      const double inertia = (D == 2 ? 0.5 : 0.4) * mass_[p] * square(material_.packing.radius[p]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double half = 0.5 * dt * now.rate[k] / now.of[k];
        double& v = velocity_[p][k];
        v = ((1 - half) * v + dt * force_[p][k] / mass_[p]) / (1 + half);
        spin_[p][k] += dt * moment_[p][k] / inertia;
        const double mean = 0.5 * (now.of[k] + next.of[k]);
        place_[p][k] = next.of[k] * (place_[p][k] / now.of[k] + dt * v / mean);
      }
    }
    find_forces(next, dt);
  }

  // Cauchy stress along an axis, with its kinetic part [Pa].
  [[nodiscard]] double stress(std::size_t axis) const { return stress_[axis]; }
  [[nodiscard]] double kinetic_energy() const {
    double energy = 0;
    for (std::size_t p = 0; p < place_.size(); ++p) {
      const double inertia = (D == 2 ? 0.5 : 0.4) * mass_[p] * square(material_.packing.radius[p]);
      energy += 0.5 * (mass_[p] * moving_cell::dot(velocity_[p], velocity_[p]) +
                       inertia * moving_cell::dot(spin_[p], spin_[p]));
    }
    return energy;
  }

 private:
  using Key = std::tuple<int, int, int, int, int>;

  static double square(double x) { return x * x; }
  static Key key(const ContactView<D>& view) {
    return {view.i, view.j, view.shift[0], view.shift[1], D == 3 ? view.shift[D - 1] : 0};
  }

  [[nodiscard]] Vector branch(const Key& pair, const Stretch& at) const {
    const auto [i, j, a, b, c] = pair;
    const Vector shift{static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)};
    Vector l = plus(place_[static_cast<std::size_t>(j)], -1, place_[static_cast<std::size_t>(i)]);
    for (std::size_t k = 0; k < 3; ++k) l[k] += at.of[k] * moving_cell::dot(cell_[k], shift);
    return l;
  }

  // All pairs that are nearer than a radius, found once.
  void find_pairs() {
    const int n = static_cast<int>(place_.size());
    const auto& radius = material_.packing.radius;
    const int deep = D == 3 ? 1 : 0;
    for (int i = 0; i < n; ++i)
      for (int j = i; j < n; ++j)
        for (int a = -1; a <= 1; ++a)
          for (int b = -1; b <= 1; ++b)
            for (int c = -deep; c <= deep; ++c) {
              if (i == j && std::tuple(a, b, c) <= std::tuple(0, 0, 0)) continue;
              const Key pair{i, j, a, b, c};
              const Vector l = branch(pair, Stretch{});
              const double reach =
                  radius[static_cast<std::size_t>(i)] + 1.5 * radius[static_cast<std::size_t>(j)];
              if (moving_cell::dot(l, l) < reach * reach) pairs_.push_back(pair);
            }
  }

  void find_forces(const Stretch& at, double dt) {
    const ContactLaw& law = material_.law;
    const auto& radius = material_.packing.radius;
    for (std::size_t p = 0; p < place_.size(); ++p) force_[p] = moment_[p] = {};
    Vector sum{};
    for (const Key& pair : pairs_) {
      const auto i = static_cast<std::size_t>(std::get<0>(pair));
      const auto j = static_cast<std::size_t>(std::get<1>(pair));
      const Vector l = branch(pair, at);
      const double distance = std::sqrt(moving_cell::dot(l, l));
      const double overlap = radius[i] + radius[j] - distance;
      if (overlap <= 0) {
        springs_.erase(pair);
        continue;
      }
      Vector normal{};
      normal = plus(normal, 1 / distance, l);
      const double kn = law.stiffness(radius[i], radius[j]);
      Vector slip = plus(velocity_[j], -1, velocity_[i]);
      for (std::size_t k = 0; k < 3; ++k) slip[k] += at.rate[k] / at.of[k] * l[k];
      Vector turning{};
      const double arm = distance / (radius[i] + radius[j]);  // over the radius
      turning = plus(plus(turning, arm * radius[i], spin_[i]), arm * radius[j], spin_[j]);
      slip = plus(slip, -1, cross(turning, normal));
      slip = plus(slip, -moving_cell::dot(slip, normal), normal);
      Vector& spring = springs_[pair];
      const double size = std::sqrt(moving_cell::dot(spring, spring));
      spring = plus(spring, -moving_cell::dot(spring, normal), normal);
      const double left = std::sqrt(moving_cell::dot(spring, spring));
      if (left > 0) spring = plus(spring, size / left - 1, spring);  // turned, not shortened
      spring = plus(spring, -law.ratio * kn * dt, slip);
      const double limit = law.friction * kn * overlap;
      const double tangential = std::sqrt(moving_cell::dot(spring, spring));
      if (tangential > limit) spring = plus(spring, limit / tangential - 1, spring);
      const Vector force = plus(spring, kn * overlap, normal);
      force_[j] = plus(force_[j], 1, force);
      force_[i] = plus(force_[i], -1, force);
      const Vector moment = cross(normal, spring);
      moment_[j] = plus(moment_[j], -arm * radius[j], moment);
      moment_[i] = plus(moment_[i], -arm * radius[i], moment);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += force[k] * l[k];
    }
    const double volume =
        material_.space.reference_volume * at.of[0] * at.of[1] * (D == 3 ? at.of[2] : 1);
    for (std::size_t k = 0; k < 3; ++k) {
      stress_[k] = -sum[k] / volume;
      for (std::size_t p = 0; p < place_.size(); ++p)
        stress_[k] -= mass_[p] * square(velocity_[p][k]) / volume;
    }
  }

  const Material<D>& material_;
  std::vector<Vector> place_, velocity_, spin_, force_, moment_;
  std::vector<double> mass_;
  Matrix cell_{};
  std::vector<Key> pairs_;
  std::map<Key, Vector> springs_;  // force on j of the tangential spring
  Vector stress_{};
};

}  // namespace grainlaw::core::moving_cell

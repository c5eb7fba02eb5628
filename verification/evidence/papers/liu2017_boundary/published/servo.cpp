// What moves the frame: eqs. 15, 21 and 32 to 36, and a direct way to the same state.

#include "evidence/papers/liu2017_boundary/published/discs.hpp"

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

std::array<double, 2> times(const Matrix2& m, const std::array<double, 2>& v) {
  return {m[0] * v[0] + m[1] * v[1], m[2] * v[0] + m[3] * v[1]};
}

double square(double value) { return value * value; }

}  // namespace

void PublishedDiscs::lead(Rule rule, const Matrix2& f) {
  for (const std::size_t p : frame_) {
    const auto x = times(f, {reference_[p], reference_[size() + p]});
    for (std::size_t c = 0; c < 2; ++c) at_[c][p] = x[c];
    if (rule != Rule::T) at_[2][p] = 0;
  }
}

void PublishedDiscs::predict(Rule rule, const Matrix2& f, const Matrix2& before,
                             double inheritance) {
  for (std::size_t q = 0; q < frame_.size(); ++q) {
    const std::size_t p = frame_[q];
    const std::array<double, 2> place{reference_[p], reference_[size() + p]};
    const auto x = times(f, place), old = times(before, place);
    const bool corner = rule == Rule::P && partner_[q] < 0;
    for (std::size_t c = 0; c < 2; ++c)
      at_[c][p] = x[c] + (corner || rule == Rule::D ? 0 : inheritance) * (at_[c][p] - old[c]);
    if (corner || rule == Rule::D) at_[2][p] = 0;
  }
}

std::array<double, 2> PublishedDiscs::holding(std::size_t q) const {
  return {-force_[0][frame_[q]], -force_[1][frame_[q]]};
}

Matrix2 PublishedDiscs::piola() const {
  Matrix2 p{};
  for (std::size_t q = 0; q < frame_.size(); ++q)
    for (std::size_t k = 0; k < 4; ++k)
      p[k] += holding(q)[k / 2] * reference_[(k % 2) * size() + frame_[q]] / (volume_ * thickness_);
  return p;
}

Matrix2 PublishedDiscs::cauchy(const Matrix2& f) const {
  const Matrix2 p = piola();
  const double j = f[0] * f[3] - f[1] * f[2];
  return {(p[0] * f[0] + p[1] * f[1]) / j, (p[0] * f[2] + p[1] * f[3]) / j,
          (p[2] * f[0] + p[3] * f[1]) / j, (p[2] * f[2] + p[3] * f[3]) / j};
}

Matrix2 PublishedDiscs::off(const Matrix2& f) const {
  Matrix2 missing = f;
  for (std::size_t q = 0; q < frame_.size(); ++q)
    for (std::size_t k = 0; k < 4; ++k)
      missing[k] -= at_[k / 2][frame_[q]] * area_[q][k % 2] / volume_;
  return missing;
}

double PublishedDiscs::off_deformation(const Matrix2& f) const {
  double sum = 0;
  for (const double value : off(f)) sum += square(value);
  return std::sqrt(sum);
}

std::array<double, 2> PublishedDiscs::missing_force(std::size_t q, const Matrix2& piola) const {
  const auto wanted = times(piola, area_[q]);
  return {wanted[0] * thickness_ - holding(q)[0], wanted[1] * thickness_ - holding(q)[1]};
}

std::array<double, 2> PublishedDiscs::missing_deformation(std::size_t q, const Matrix2& off) const {
  const auto missing = times(off, area_[q]);
  return {volume_ * missing[0], volume_ * missing[1]};
}

double PublishedDiscs::unbalanced_frame() const {
  const Matrix2 p = piola();
  double largest = 0;
  for (std::size_t q = 0; q < frame_.size(); ++q)
    largest = std::max(largest, std::hypot(missing_force(q, p)[0], missing_force(q, p)[1]));
  return largest / contact_force_;
}

Residuals PublishedDiscs::residuals(Rule rule, const Matrix2& f,
                                    const PublishedValues& values) const {
  double force = 0, deformation = 0, corners = 0, of_corners = 1;
  const Matrix2 p = piola(), apart = off(f);
  for (std::size_t q = 0; q < frame_.size(); ++q) {
    const double r = radius_[frame_[q]];
    const double scale = mass_[frame_[q]] * r / square(values.time_step);  // eq. 37
    if (rule == Rule::T) {
      const auto a = missing_force(q, p), u = missing_deformation(q, apart);
      force += (square(a[0]) + square(a[1])) / square(scale);
      deformation += (square(u[0]) + square(u[1])) / square(r * r * r);
    } else if (partner_[q] < 0) {
      corners += -force_[2][frame_[q]];
      of_corners = scale * r;
    } else if (const auto other = static_cast<std::size_t>(partner_[q]); q < other) {
      const auto a = holding(q), b = holding(other);
      const double moment = force_[2][frame_[q]] + force_[2][frame_[other]];
      force += (square(a[0] + b[0]) + square(a[1] + b[1])) / square(scale) +
               square(moment / (scale * r));
    }
  }
  return {std::sqrt(force + square(corners / of_corners)), std::sqrt(deformation)};
}

void PublishedDiscs::correct(Rule rule, const Matrix2& f, const PublishedValues& values) {
  const Matrix2 p = piola(), apart = off(f);
  double corners = 0;
  for (std::size_t q = 0; q < frame_.size(); ++q)
    if (rule == Rule::P && partner_[q] < 0) corners += force_[2][frame_[q]];
  for (std::size_t q = 0; q < frame_.size(); ++q) {
    const std::size_t k = frame_[q];
    const double unit = square(values.time_step) / mass_[k], r = radius_[k];
    if (rule == Rule::T) {
      const auto a = missing_force(q, p), u = missing_deformation(q, apart);
      for (std::size_t c = 0; c < 2; ++c)
        at_[c][k] +=
            values.gain_force_of_t * unit * a[c] + values.gain_deformation / (r * r) * u[c];
      continue;
    }
    // Both of a pair go where their contacts push them together: against a+ + a-.
    const double turn = values.gain_moment * unit / (r * r);
    if (partner_[q] < 0) {
      at_[2][k] += turn * corners;
      continue;
    }
    const auto other = static_cast<std::size_t>(partner_[q]);
    for (std::size_t c = 0; c < 2; ++c)
      at_[c][k] -= values.gain_force * unit * (holding(q)[c] + holding(other)[c]);
    at_[2][k] += turn * (force_[2][k] + force_[2][frame_[other]]);
  }
}

void PublishedDiscs::project(std::array<std::vector<double>, 3>& field, bool forces) const {
  std::array<double, 3> g{};  // sum of A A / m
  for (std::size_t q = 0; q < frame_.size(); ++q) {
    const double m = mass_[frame_[q]];
    g[0] += area_[q][0] * area_[q][0] / m;
    g[1] += area_[q][0] * area_[q][1] / m;
    g[2] += area_[q][1] * area_[q][1] / m;
  }
  const double determinant = g[0] * g[2] - g[1] * g[1];
  for (std::size_t c = 0; c < 2; ++c) {
    std::array<double, 2> sum{};
    for (std::size_t q = 0; q < frame_.size(); ++q)
      for (std::size_t k = 0; k < 2; ++k)
        sum[k] += area_[q][k] * field[c][frame_[q]] / (forces ? mass_[frame_[q]] : 1);
    const std::array<double, 2> by{(g[2] * sum[0] - g[1] * sum[1]) / determinant,
                                   (g[0] * sum[1] - g[1] * sum[0]) / determinant};
    for (std::size_t q = 0; q < frame_.size(); ++q)
      field[c][frame_[q]] -=
          (area_[q][0] * by[0] + area_[q][1] * by[1]) / (forces ? 1 : mass_[frame_[q]]);
  }
}

bool PublishedDiscs::relax_directly(const Matrix2& f, int max_steps) {
  constexpr double tolerance = 1e-6, gone = 1e-2;  // of the mean contact force; of that at first
  const double dt = 0.3 * critical_step(), damping = PublishedValues().damping;
  // What the mean deformation misses is given to the frame at once.
  const Matrix2 apart = off(f);
  std::array<double, 3> g{};
  for (const auto& a : area_) g[0] += a[0] * a[0], g[1] += a[0] * a[1], g[2] += a[1] * a[1];
  const double determinant = g[0] * g[2] - g[1] * g[1];
  for (std::size_t q = 0; q < frame_.size(); ++q)
    for (std::size_t c = 0; c < 2; ++c) {
      const double u = volume_ * apart[2 * c], v = volume_ * apart[2 * c + 1];
      at_[c][frame_[q]] +=
          (area_[q][0] * (g[2] * u - g[1] * v) + area_[q][1] * (g[0] * v - g[1] * u)) / determinant;
    }
  for (auto& component : velocity_) std::fill(component.begin(), component.end(), 0.0);
  double first = 0;
  for (int k = 0; k < max_steps; ++k) {
    update_forces();
    if (k == 0) first = contact_force_;
    if (!std::isfinite(potential_) || contact_force_ <= gone * first) return false;
    project(force_, true);
    double largest = 0;
    for (std::size_t p = 0; p < size(); ++p)
      for (std::size_t c = 0; c < 3; ++c) {
        const double force = force_[c][p];
        largest = std::max(largest, std::abs(force) / (c < 2 ? 1 : radius_[p]));
        const double mass = c < 2 ? mass_[p] : 0.5 * mass_[p] * radius_[p] * radius_[p];
        double& v = velocity_[c][p];
        v += dt * (v != 0 ? force - damping * std::copysign(std::abs(force), v) : force) / mass;
      }
    if (largest < tolerance * contact_force_) {
      for (auto& component : velocity_) std::fill(component.begin(), component.end(), 0.0);
      update_forces();
      return true;
    }
    project(velocity_, false);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t p = 0; p < size(); ++p) at_[c][p] += dt * velocity_[c][p];
    ++steps_;
  }
  return false;
}

}  // namespace verification

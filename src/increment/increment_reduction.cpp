// What a boundary space makes of forces and masses: the parts of Increment that only frames use.
#include "increment/increment.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw {

namespace {

// Symmetric 2x2 (xx, xy, yy), inverted; with one row only xx.
std::array<double, 3> inverse(const std::array<double, 3>& a, std::size_t rows) {
  if (rows == 1) return {1 / a[0], 0, 0};
  const double det = a[0] * a[2] - a[1] * a[1];
  return {a[2] / det, -a[1] / det, a[0] / det};
}

std::array<double, 2> apply(const std::array<double, 3>& a, const std::array<double, 2>& b) {
  return {a[0] * b[0] + a[1] * b[1], a[1] * b[0] + a[2] * b[1]};
}

double component(const ForceRecord& record, std::size_t direction) {
  return direction == 0 ? record.x : record.y;
}

}  // namespace

void Increment::reduce(std::span<ForceRecord> residual) const {
  const auto& space = *problem->space;
  if (space.identity) return;
  for (std::size_t q = 0; q < nodes(); ++q) {
    const unsigned char fixed = space.fixed[q];
    if (fixed == 0) continue;
    if ((fixed & fixed_x) != 0) residual[q].x = 0;
    if ((fixed & fixed_y) != 0) residual[q].y = 0;
    if ((fixed & fixed_rotation) != 0) residual[q].roll = 0;
  }
  if (space.averages()) take_averages(residual);
  if (!space.finds_deformation) return;
  // V (P* - P) with V P = - sum f (x) L.
  std::array<double, 4> force{};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& f = contacts.forces[c];
    if (f.x == 0 && f.y == 0) continue;
    const auto branch = fixed_branch(c);
    for (std::size_t k = 0; k < 4; ++k) force[k] += (k < 2 ? f.x : f.y) * branch[k % 2];
  }
  for (std::size_t k = 0; k < 4; ++k) {
    force[k] = space.found[k]
                   ? (force[k] + space.reference_volume * space.stress[k]) / deformation_scale_
                   : 0;
  }
  residual[nodes()] = {force[0], force[1], 0, 0};
  residual[nodes() + 1] = {force[2], force[3], 0, 0};
}

// C = [sum r (x) A / m] [sum A (x) A / m]^-1, and r - C A.
void Increment::take_averages(std::span<ForceRecord> residual) const {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = problem->space->average[i];
    if (average.rows == 0) continue;
    std::array<double, 2> sum{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const auto q = static_cast<std::size_t>(average.node[k]);
      const double a = component(residual[q], i) / component(mass_records[q], i);
      sum[0] += a * average.row[k][0];
      sum[1] += a * average.row[k][1];
    }
    const auto c = apply(average_mass_[i], sum);
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      auto& r = residual[static_cast<std::size_t>(average.node[k])];
      (i == 0 ? r.x : r.y) -= c[0] * average.row[k][0] + c[1] * average.row[k][1];
    }
  }
}

std::array<double, 2> Increment::fixed_branch(std::size_t c) const {
  const auto n = particles();
  const double* x = problem->space->reference.data();
  const auto i = static_cast<std::size_t>(contacts.i[c]);
  const auto j = static_cast<std::size_t>(contacts.j[c]);
  return {x[j] - x[i], x[n + j] - x[n + i]};
}

void Increment::find_average_masses() {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = problem->space->average[i];
    if (average.rows == 0) continue;
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const double m = component(mass_records[static_cast<std::size_t>(average.node[k])], i);
      const auto& row = average.row[k];
      sum[0] += row[0] * row[0] / m;
      sum[1] += row[0] * row[1] / m;
      sum[2] += row[1] * row[1] / m;
    }
    average_mass_[i] = inverse(sum, average.rows);
  }
}

// A contact's stretch (w_j - w_i + dF L) is shared by two particles and by the found components of
// a row of F; masses 0.8 sum kn L^2 times their number keep the unit step stable.
void Increment::find_deformation_masses() {
  const auto& space = *problem->space;
  if (!space.finds_deformation) return;
  constexpr double factor = 0.8;
  std::array<double, 2> sum{};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double kn = contacts.forces[c].x;  // left there by sum_stiffnesses; 0 when open
    if (kn == 0) continue;
    const auto branch = fixed_branch(c);
    sum[0] += kn * branch[0] * branch[0];
    sum[1] += kn * branch[1] * branch[1];
  }
  const double scale = deformation_scale_ * deformation_scale_;
  const double least = mean_stiffness() * mean_branch_ * mean_branch_ / scale;
  for (std::size_t i = 0; i < 2; ++i) {
    const double number = (space.found[2 * i] ? 1 : 0) + (space.found[2 * i + 1] ? 1 : 0);
    const auto mass_of = [&](std::size_t j) {
      return factor * std::max(number * sum[j] / scale, least);
    };
    mass_records[nodes() + i] = {mass_of(0), mass_of(1), 1, 1};
  }
}

void Increment::change_deformation(const double* rows, std::vector<ParticleRecord>& moved) {
  const auto& space = *problem->space;
  const auto n = particles();
  std::array<double, 4> change{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (space.found[k]) change[k] = rows[4 * (k / 2) + k % 2] / deformation_scale_;
    deformation[k] += change[k];
  }
  const double* x = space.reference.data();
  for (std::size_t p = 0; p < n; ++p) {
    moved[p].x += change[0] * x[p] + change[1] * x[n + p];
    moved[p].y += change[2] * x[p] + change[3] * x[n + p];
  }
}

void Increment::hold_average(std::span<double> velocity, std::span<const double> mass_of) const {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = problem->space->average[i];
    if (average.rows == 0) continue;
    std::array<double, 2> off{};
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const std::size_t q = i * nodes() + static_cast<std::size_t>(average.node[k]);
      const auto& row = average.row[k];
      off[0] += row[0] * velocity[q];
      off[1] += row[1] * velocity[q];
      sum[0] += row[0] * row[0] / mass_of[q];
      sum[1] += row[0] * row[1] / mass_of[q];
      sum[2] += row[1] * row[1] / mass_of[q];
    }
    const auto c = apply(inverse(sum, average.rows), off);
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const std::size_t q = i * nodes() + static_cast<std::size_t>(average.node[k]);
      velocity[q] -= (c[0] * average.row[k][0] + c[1] * average.row[k][1]) / mass_of[q];
    }
  }
}

int Increment::released_particle() {
  const auto& space = *problem->space;
  held_.assign(nodes(), 0);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (overlap(c) <= 0) continue;
    held_[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.i[c])])] = 1;
    held_[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.j[c])])] = 1;
  }
  for (const auto& average : space.average) {
    for (const auto q : average.node) {
      if (held_[static_cast<std::size_t>(q)]) continue;
      return static_cast<int>(std::find(space.node.begin(), space.node.end(), q) -
                              space.node.begin());
    }
  }
  return -1;
}

bool Increment::collapsed() {
  if (!problem->space->averages()) return false;
  return mean_force < problem->force_floor || released_particle() >= 0;
}

}  // namespace grainlaw

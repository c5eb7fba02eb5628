#include "frame/average_masses.hpp"

#include <cstddef>

namespace grainlaw::core {

namespace {

// Inverse of a symmetric 2x2 matrix (xx, xy, yy); with one row only xx counts.
std::array<double, 3> inverse(const std::array<double, 3>& a, std::size_t rows) {
  if (rows == 1) return {1 / a[0], 0, 0};
  const double det = a[0] * a[2] - a[1] * a[1];
  return {a[2] / det, -a[1] / det, a[0] / det};
}

std::array<double, 2> times(const std::array<double, 3>& a, const std::array<double, 2>& b) {
  return {a[0] * b[0] + a[1] * b[1], a[1] * b[0] + a[2] * b[1]};
}

template <class Record>
double component(const Record& record, std::size_t direction) {
  return direction == 0 ? record.x : record.y;
}

}  // namespace

void AverageMasses::find(const BoundarySpace<2>& space, std::span<const MassRecord<2>> mass) {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = space.average[i];
    if (average.rows == 0) continue;
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const double m = component(mass[static_cast<std::size_t>(average.node[k])], i);
      const auto& row = average.row[k];
      sum[0] += row[0] * row[0] / m;
      sum[1] += row[0] * row[1] / m;
      sum[2] += row[1] * row[1] / m;
    }
    inverse_[i] = inverse(sum, average.rows);
  }
}

void AverageMasses::take_out(const BoundarySpace<2>& space, std::span<const MassRecord<2>> mass,
                             std::span<ForceRecord<2>> residual) const {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = space.average[i];
    if (average.rows == 0) continue;
    std::array<double, 2> sum{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const auto q = static_cast<std::size_t>(average.node[k]);
      const double a = component(residual[q], i) / component(mass[q], i);
      sum[0] += a * average.row[k][0];
      sum[1] += a * average.row[k][1];
    }
    const auto c = times(inverse_[i], sum);
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      auto& r = residual[static_cast<std::size_t>(average.node[k])];
      (i == 0 ? r.x : r.y) -= c[0] * average.row[k][0] + c[1] * average.row[k][1];
    }
  }
}

void AverageMasses::project_out_velocity(const BoundarySpace<2>& space, std::size_t nodes,
                                         std::span<double> velocity, std::span<const double> mass) {
  const auto mass_of = [&](std::size_t q) { return mass.empty() ? 1.0 : mass[q]; };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = space.average[i];
    if (average.rows == 0) continue;
    std::array<double, 2> off{};
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const std::size_t q = i * nodes + static_cast<std::size_t>(average.node[k]);
      const auto& row = average.row[k];
      off[0] += row[0] * velocity[q];
      off[1] += row[1] * velocity[q];
      sum[0] += row[0] * row[0] / mass_of(q);
      sum[1] += row[0] * row[1] / mass_of(q);
      sum[2] += row[1] * row[1] / mass_of(q);
    }
    const auto c = times(inverse(sum, average.rows), off);
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const std::size_t q = i * nodes + static_cast<std::size_t>(average.node[k]);
      velocity[q] -= (c[0] * average.row[k][0] + c[1] * average.row[k][1]) / mass_of(q);
    }
  }
}

}  // namespace grainlaw::core

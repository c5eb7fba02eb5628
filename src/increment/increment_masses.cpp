// Pseudo-masses of the nodes, by which relaxation steps and what residuals are weighed with.
#include "contact/frictional.hpp"
#include "increment/increment.hpp"

#include <algorithm>

namespace grainlaw {

void Increment::find_least_masses() {
  const auto& law = *problem->law;
  least_masses_.resize(nodes());
  for (std::size_t q = 0; q < nodes(); ++q) {
    const double r = node_radius[q];
    const double kn = law.stiffness(r, r);
    double kt = law.rotating() ? 2 * law.ratio * kn : 1;
    if (law.moments()) kt += law.ratio * kn * law.rolling_ratio(r, r) / (r * r);
    least_masses_[q] = {kn, kn, kt, 1 / r};
  }
}

void Increment::refresh_masses() {
  load_records();
  sum_masses();
  const auto m = nodes();
  const bool rotating = problem->law->rotating();
  for (std::size_t q = 0; q < m; ++q) {
    const double r = node_radius[q];
    mass[q] = mass[m + q] = mass_records[q].x;
    if (rotating) mass[2 * m + q] = mass_records[q].roll * r * r;
  }
  if (!problem->space->finds_deformation) return;
  for (std::size_t i = 0; i < 2; ++i) {
    mass[node_unknowns() + 2 * i] = mass_records[m + i].x;
    mass[node_unknowns() + 2 * i + 1] = mass_records[m + i].y;
  }
}

void Increment::sum_masses() {
  const auto totals = sum_stiffnesses(records, *problem->law, contacts, mass_records);
  touching = totals.touching;
  mean_force = touching > 0 ? totals.force / totals.weights : 0;
  for (std::size_t q = 0; q < nodes(); ++q) {
    auto& mass_of = mass_records[q];
    const auto& least = least_masses_[q];
    mass_of.x = mass_of.y = mass_factor * std::max(mass_of.x, least.x);
    mass_of.roll = mass_factor * std::max(mass_of.roll * least.unused, least.roll);
    mass_of.unused = 1;
  }
  if (problem->space->identity) return;
  find_average_masses();
  find_deformation_masses();
}

double Increment::mean_stiffness() const {
  double sum = 0;
  for (std::size_t q = 0; q < nodes(); ++q) sum += least_masses_[q].x;
  return sum / static_cast<double>(nodes());
}

}  // namespace grainlaw

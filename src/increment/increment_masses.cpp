// Pseudo-masses of the nodes, by which relaxation steps and what residuals are weighed with.
#include "base/constants.hpp"
#include "contact/contact_forces.hpp"
#include "increment/increment.hpp"
#include "increment/records.hpp"

namespace grainlaw::core {

template <int D>
void Increment<D>::find_least_masses() {
  least_masses_.resize(nodes());
  for (std::size_t q = 0; q < nodes(); ++q) {
    least_masses_[q] = least_mass<D>(*problem->law, node_radius[q]);
  }
}

template <int D>
void Increment<D>::refresh_masses() {
  load_records();
  sum_masses();
  put_masses(mass_records.data(), node_radius, problem->law->rotating(), mass.data());
  if (!problem->space->finds_deformation) return;
  for (std::size_t i = 0; i < dim; ++i) {
    std::copy_n(&mass_records[nodes() + i].x, dim, mass.data() + node_unknowns() + dim * i);
  }
}

template <int D>
void Increment<D>::sum_masses() {
  const auto totals = sum_stiffnesses<D>(records, *problem->law, contacts, stiffness_);
  touching = totals.touching;
  mean_force = touching > 0 ? totals.force / totals.weights : 0;
  for (std::size_t q = 0; q < nodes(); ++q) {
    mass_records[q] = mass_of(stiffness_[q], least_masses_[q], tuned::mass_factor);
  }
  if (problem->space->identity) return;
  find_average_masses();
  find_deformation_masses();
}

template <int D>
void Increment<D>::find_average_masses() {
  if constexpr (D == 2) {
    if (problem->space->averages()) average_masses_.find(*problem->space, mass_records);
  }
}

// A contact's stretch (w_j - w_i + dF L) is shared by two particles and by the found components of
// a row of F; masses 0.8 sum kn L^2 times their number keep the unit step stable.
template <int D>
void Increment<D>::find_deformation_masses() {
  const auto& space = *problem->space;
  if (!space.finds_deformation) return;
  Vec<D> sum{};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double kn = contacts.stiffness[c].x;
    if (kn == 0) continue;
    const auto branch = fixed_branch(c);
    for (std::size_t k = 0; k < dim; ++k) sum[k] += kn * branch[k] * branch[k];
  }
  const double scale = deformation_scale_ * deformation_scale_;
  const double least = mean_stiffness() * mean_branch_ * mean_branch_ / scale;
  for (std::size_t i = 0; i < dim; ++i) {
    double number = 0;
    for (std::size_t j = 0; j < dim; ++j) number += space.found[dim * i + j] ? 1 : 0;
    MassRecord<D> row{};
    for (std::size_t j = 0; j < dim; ++j) {
      (&row.x)[j] = tuned::deformation_mass_factor * std::max(number * sum[j] / scale, least);
    }
    mass_records[nodes() + i] = row;
  }
}

template <int D>
double Increment<D>::mean_stiffness() const {
  double sum = 0;
  for (std::size_t q = 0; q < nodes(); ++q) sum += least_masses_[q].x;
  return sum / static_cast<double>(nodes());
}

template class Increment<2>;
template class Increment<3>;

}  // namespace grainlaw::core

#include "increment/masses.hpp"

#include "base/constants.hpp"
#include "increment/mass_factor.hpp"
#include "increment/records.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Stiffness of a Hertz contact that the strain of the increment closes, over that at F = I; at least 1
// [-]. Contacts that close between two updates of the masses become as stiff. With smaller masses
// relaxation is unstable, and particles pass through one another.
template <int D>
double stiffening(const Problem<D>& problem, const Motion<D>& motion) {
  if (problem.hertz_overlap == 0) return 1;
  double squares = 0;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    const double change = motion.deformation()[k] - motion.start_deformation()[k];
    squares += change * change;
  }
  const double overlap = 2 * std::sqrt(squares);  // of two particles of a radius of 1
  return std::max(1.0, std::sqrt(overlap / problem.hertz_overlap));
}

inline LeastMass<2> times(double factor, const LeastMass<2>& least) {
  return {factor * least.x, factor * least.y, factor * least.roll, least.inverse_radius};
}
inline LeastMass<3> times(double factor, const LeastMass<3>& least) {
  return {factor * least.x, factor * least.spin, least.inverse_radius};
}

}  // namespace

template <int D>
void Masses<D>::begin(const Problem<D>& problem, const Motion<D>& motion) {
  const auto nodes = problem.nodes();
  records_.resize(nodes + problem.rows());
  of_unknowns_.resize(problem.unknowns());
  stiffness_.resize(nodes);
  least_.resize(nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    least_[q] = least_mass<D>(*problem.law, motion.node_radius()[q]);
  }
  if (problem.space->identity) return;
  for (std::size_t q = 0; q < nodes; ++q) records_[q] = mass_of({}, least_[q], 1);
  find_averages(*problem.space);
}

template <int D>
ContactTotals Masses<D>::sum(const Problem<D>& problem, const Motion<D>& motion,
                             ContactList<D>& contacts) {
  const auto totals = sum_stiffnesses<D>(motion.records(), *problem.law, contacts, stiffness_);
  const double stiffer = stiffening(problem, motion), factor = mass_factor(*problem.law);
  for (std::size_t q = 0; q < problem.nodes(); ++q) {
    records_[q] = mass_of(stiffness_[q], times(stiffer, least_[q]), factor);
  }
  if (motion.drag().acts()) motion.drag().add_to(std::span(records_), tuned::mass_factor);
  if (problem.space->identity) return totals;
  find_averages(*problem.space);
  if (problem.space->finds_deformation) find_rows(problem, motion, contacts);
  return totals;
}

template <int D>
void Masses<D>::put(const Problem<D>& problem, const Motion<D>& motion) {
  put_masses(records_.data(), motion.node_radius(), problem.law->rotating(), of_unknowns_.data());
  for (std::size_t i = 0; i < problem.rows(); ++i) {
    std::copy_n(&records_[problem.nodes() + i].x, D,
                of_unknowns_.data() + problem.node_unknowns() + D * i);
  }
}

template <int D>
void Masses<D>::find_averages(const BoundarySpace<D>& space) {
  if constexpr (D == 2) {
    if (space.averages()) averages_.find(space, records_);
  }
}

template <int D>
void Masses<D>::project_out_averages(const BoundarySpace<D>& space,
                                     std::span<ForceRecord<D>> residual) const {
  if constexpr (D == 2) {
    if (space.averages()) averages_.take_out(space, records_, residual);
  }
}

// Finds the masses of found components of F. Two particles and the components of a row share the
// stretch (w_j - w_i + dF L) of a contact. Masses 0.8 sum kn L^2 times their number keep the unit
// step stable, and larger ones where kt is.
template <int D>
void Masses<D>::find_rows(const Problem<D>& problem, const Motion<D>& motion,
                          const ContactList<D>& contacts) {
  const auto& space = *problem.space;
  Vec<D> sum{};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double kn = contacts.stiffness[c].x;
    if (kn == 0) continue;
    const auto branch = motion.fixed_branch(contacts.i[c], contacts.j[c]);
    for (std::size_t k = 0; k < D; ++k) sum[k] += kn * branch[k] * branch[k];
  }
  const double factor = tuned::deformation_mass_factor * largest_over_normal(*problem.law);
  const double scale = motion.deformation_scale() * motion.deformation_scale();
  const double least = mean_stiffness() * motion.mean_branch() * motion.mean_branch() / scale;
  for (std::size_t i = 0; i < D; ++i) {
    double number = 0;
    for (std::size_t j = 0; j < D; ++j) number += space.found[D * i + j] ? 1 : 0;
    MassRecord<D> row{};
    for (std::size_t j = 0; j < D; ++j) {
      component(row, j) = factor * std::max(number * sum[j] / scale, least);
    }
    records_[problem.nodes() + i] = row;
  }
}

template <int D>
double Masses<D>::mean_stiffness() const {
  double sum = 0;
  for (const auto& least : least_) sum += least.x;
  return sum / static_cast<double>(least_.size());
}

template class Masses<2>;
template class Masses<3>;

}  // namespace grainlaw::core

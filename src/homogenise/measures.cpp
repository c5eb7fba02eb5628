#include "homogenise/measures.hpp"

#include "frame/frame_space.hpp"
#include "homogenise/kinetic_stress.hpp"
#include "homogenise/plane_measures.hpp"
#include "homogenise/space_measures.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

template <int D>
Tensor<D> cauchy_stress(const Configuration<D>& at) {
  const double det = determinant<D>(at.deformation);
  Tensor<D> sigma{};
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < D; ++j) {
      sigma[D * i + j] = dot<D>(at.stress.data() + D * i, at.deformation.data() + D * j) / det;
    }
  }
  return sigma;
}

// Weighted number of contacts per source particle; copies add to one source.
template <int D>
std::vector<double> contacts_of_sources(const Problem<D>& problem,
                                        const std::vector<ContactView<D>>& contacts) {
  std::vector<double> count(problem.space->sources, 0.0);
  const auto& source = problem.space->source;
  for (const auto& c : contacts) {
    count[static_cast<std::size_t>(source[static_cast<std::size_t>(c.i)])] += c.weight;
    count[static_cast<std::size_t>(source[static_cast<std::size_t>(c.j)])] += c.weight;
  }
  return count;
}

template <int D>
double weighted_number(const std::vector<ContactView<D>>& contacts) {
  double number = 0;
  for (const auto& c : contacts) number += c.weight;
  return number;
}

template <int D>
double coordination(const Problem<D>& problem, const std::vector<ContactView<D>>& contacts,
                    bool rattlers) {
  const double number = weighted_number(contacts);
  const auto particles = static_cast<double>(problem.space->sources);
  if (rattlers) return 2 * number / particles;
  double none = 0;
  double one = 0;
  for (const double count : contacts_of_sources(problem, contacts)) {
    none += count < 0.5 ? 1 : 0;
    one += count >= 0.5 && count < 1.5 ? 1 : 0;
  }
  const double bearing = particles - none - one;
  return bearing > 0 ? (2 * number - one) / bearing : 0;
}

template <int D>
Tensor<D> fabric(const std::vector<ContactView<D>>& contacts) {
  Tensor<D> phi{};
  const double number = weighted_number(contacts);
  for (const auto& c : contacts) {
    const double share = c.weight / (number * square<D>(c.branch));
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = i; j < D; ++j) {
        phi[D * i + j] += share * c.branch[i] * c.branch[j];
        phi[D * j + i] = phi[D * i + j];
      }
    }
  }
  return phi;
}

// Squared norm of a spring's force or moment.
template <std::size_t components>
double sum_of_squares(const std::array<double, components>& force) {
  double sum = force[0] * force[0];
  for (std::size_t k = 1; k < components; ++k) sum += force[k] * force[k];
  return sum;
}

// Moment of twisting or torsion along the normal [N m].
double moment_along(const ContactView<2>& /*contact*/) { return 0; }
double moment_along(const ContactView<3>& c) {
  return dot<3>(c.moment.data(), c.branch.data()) / length<3>(c.branch);
}

// Overlap that carries force; an unbonded contact carries no tension [m].
template <int D>
double load_bearing_overlap(const ContactView<D>& c) {
  return c.bonded ? c.overlap + c.bond_gap : std::max(c.overlap, 0.0);
}

template <int D>
double elastic_energy(const Problem<D>& problem, const std::vector<ContactView<D>>& contacts) {
  double energy = 0;
  const auto& radius = problem.packing->radius;
  const ContactLaw &law = *problem.law, of_bonds = law.of_bonds();
  for (const auto& c : contacts) {
    const double along = moment_along(c);
    energy +=
        c.weight * (c.bonded ? of_bonds : law)
                       .energy(radius[static_cast<std::size_t>(c.i)],
                               radius[static_cast<std::size_t>(c.j)], load_bearing_overlap(c),
                               sum_of_squares(c.tangential_force),
                               sum_of_squares(c.moment) - along * along, along * along, c.bonded);
  }
  return energy;
}

// Mean rotation per component since F = I; a rotation vector for spheres [rad].
template <int D>
std::array<double, Dimension<D>::spins> mean_rotation(const Problem<D>& problem,
                                                      const Configuration<D>& at) {
  const auto n = problem.packing->size();
  std::array<double, Dimension<D>::spins> mean{};
  if (at.coordinates.size() < (D + Dimension<D>::rotation_numbers) * n) return mean;
  // Copies on a frame share their rotation and count once.
  std::vector<std::array<double, Dimension<D>::spins>> rotation(problem.space->nodes);
  for (std::size_t p = 0; p < n; ++p) {
    rotation[static_cast<std::size_t>(problem.space->node[p])] =
        rotation_of<D>(at.coordinates.data() + D * n + p, n);
  }
  for (std::size_t k = 0; k < mean.size(); ++k) {
    double sum = 0;
    for (const auto& value : rotation) sum += value[k];
    mean[k] = sum / static_cast<double>(rotation.size());
  }
  return mean;
}

}  // namespace

template <int D>
std::vector<ContactView<D>> contact_views(const Problem<D>& problem, const Configuration<D>& at) {
  const auto& packing = *problem.packing;
  const auto n = packing.size();
  const Tensor<D> cell = packing.frame ? Tensor<D>{} : tensor_of<D>(packing.cell);
  std::vector<NeighbourPair<D>> pairs;
  for (const auto& c : at.contacts) pairs.push_back({c.i, c.j, c.shift});
  std::vector<double> weights(pairs.size(), 1.0);
  if constexpr (D == 2) {
    if (packing.frame) weigh_copies(*problem.space, packing, pairs, weights);
  }
  const ContactLaw &law = *problem.law, of_bonds = law.of_bonds();
  std::vector<ContactView<D>> views;
  views.reserve(at.contacts.size());
  for (std::size_t k = 0; k < at.contacts.size(); ++k) {
    const auto& c = at.contacts[k];
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    ContactView<D> view{};
    view.i = c.i;
    view.j = c.j;
    std::copy(c.shift.begin(), c.shift.end(), view.shift.begin());
    view.branch = branch<D>(at.coordinates.data(), n, i, j, at.deformation,
                            product<D>(cell, vec_of<D>(c.shift)));
    view.overlap = packing.radius[i] + packing.radius[j] - length<D>(view.branch);
    view.bonded = c.bonded;
    view.bond_gap = at.bond_gaps.empty() ? 0 : at.bond_gaps[k];
    for (std::size_t s = 0; s < view.moment.size(); ++s) {
      view.moment[s] = at.moments.empty() ? 0 : at.moments[view.moment.size() * k + s];
    }
    view.normal_force =
        (view.bonded ? of_bonds : law)
            .normal_force(packing.radius[i], packing.radius[j], load_bearing_overlap(view));
    view.tangential_force = c.tangential_force;
    view.weight = weights[k];
    views.push_back(view);
  }
  return views;
}

int measure_count(int dimension, grainlaw_measure what) {
  switch (what) {
#define GRAINLAW_X(name, value, count, text)          \
  case name:                                          \
    return (count) == -2   ? dimension * dimension    \
           : (count) == -1 ? (dimension == 2 ? 1 : 3) \
                           : (count);
    GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  }
  return -1;
}

template <int D>
void measure(const Problem<D>& problem, const Configuration<D>& at, grainlaw_measure what,
             double* value) {
  const double volume = problem.space->reference_volume * determinant<D>(at.deformation);
  const auto contacts = contact_views(problem, at);
  const auto copy = [&](const auto& tensor) { std::copy(tensor.begin(), tensor.end(), value); };
  switch (what) {
    case GRAINLAW_CAUCHY_STRESS:
      return copy(cauchy_stress(at));
    case GRAINLAW_VOLUME:
      *value = volume;
      return;
    case GRAINLAW_VOID_RATIO:
      *value = volume / problem.space->solid_volume - 1;
      return;
    case GRAINLAW_COORDINATION:
      *value = coordination(problem, contacts, true);
      return;
    case GRAINLAW_COORDINATION_NO_RATTLERS:
      *value = coordination(problem, contacts, false);
      return;
    case GRAINLAW_FABRIC:
      return copy(fabric(contacts));
    case GRAINLAW_ANISOTROPY:
      *value = anisotropy(fabric(contacts));
      return;
    case GRAINLAW_FABRIC_INTENSITY:
      *value = fabric_intensity(fabric(contacts));
      return;
    case GRAINLAW_MEAN_OVERLAP: {
      double sum = 0;
      for (const auto& c : contacts) sum += c.weight * c.overlap;
      *value = contacts.empty() ? 0 : sum / weighted_number(contacts);
      return;
    }
    case GRAINLAW_MEAN_ROTATION:
      return copy(mean_rotation(problem, at));
    case GRAINLAW_ELASTIC_ENERGY:
      *value = elastic_energy(problem, contacts);
      return;
    case GRAINLAW_DISSIPATED_ENERGY:
      *value = at.dissipated;
      return;
    case GRAINLAW_BROKEN_BONDS:
      *value = at.broken_bonds;
      return;
    case GRAINLAW_CONTACTS:
      *value = weighted_number(contacts);
      return;
    case GRAINLAW_PARTICLES:
      *value = static_cast<double>(problem.space->sources);
      return;
    case GRAINLAW_REFERENCE_VOLUME:
      *value = problem.space->reference_volume;
      return;
    case GRAINLAW_DEFORMATION_GRADIENT:
      return copy(at.deformation);
    case GRAINLAW_KINETIC_ENERGY:
      *value = kinetic_energy(problem, at);
      return;
    case GRAINLAW_ESCAPED_PARTICLES:
      *value = 0;
      if constexpr (D == 2) *value = escaped_particles(problem, at);
      return;
  }
}

template std::vector<ContactView<2>> contact_views(const Problem<2>&, const Configuration<2>&);
template void measure(const Problem<2>&, const Configuration<2>&, grainlaw_measure, double*);
template std::vector<ContactView<3>> contact_views(const Problem<3>&, const Configuration<3>&);
template void measure(const Problem<3>&, const Configuration<3>&, grainlaw_measure, double*);

}  // namespace grainlaw::core

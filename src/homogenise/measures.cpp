#include "homogenise/measures.hpp"

#include "frame/frame_geometry.hpp"
#include "frame/frame_space.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw {

namespace {

std::array<double, 4> cauchy_stress(const Configuration& at) {
  const auto& p = at.stress;
  const auto& f = at.deformation;
  const double det = f[0] * f[3] - f[1] * f[2];
  return {(p[0] * f[0] + p[1] * f[1]) / det, (p[0] * f[2] + p[1] * f[3]) / det,
          (p[2] * f[0] + p[3] * f[1]) / det, (p[2] * f[2] + p[3] * f[3]) / det};
}

// Weighted number of contacts of every particle, copies being one.
std::vector<double> contacts_of_sources(const Problem& problem,
                                        const std::vector<ContactView>& contacts) {
  std::vector<double> count(problem.space->sources, 0.0);
  const auto& source = problem.space->source;
  for (const auto& c : contacts) {
    count[static_cast<std::size_t>(source[static_cast<std::size_t>(c.i)])] += c.weight;
    count[static_cast<std::size_t>(source[static_cast<std::size_t>(c.j)])] += c.weight;
  }
  return count;
}

double weighted_number(const std::vector<ContactView>& contacts) {
  double number = 0;
  for (const auto& c : contacts) number += c.weight;
  return number;
}

double coordination(const Problem& problem, const std::vector<ContactView>& contacts,
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

std::array<double, 4> fabric(const std::vector<ContactView>& contacts) {
  std::array<double, 4> phi{};
  const double number = weighted_number(contacts);
  for (const auto& c : contacts) {
    const double d2 = c.branch_x * c.branch_x + c.branch_y * c.branch_y;
    const double share = c.weight / (number * d2);
    phi[0] += share * c.branch_x * c.branch_x;
    phi[1] += share * c.branch_x * c.branch_y;
    phi[2] += share * c.branch_x * c.branch_y;
    phi[3] += share * c.branch_y * c.branch_y;
  }
  return phi;
}

// Half the difference of the fabric's eigenvalues.
double half_difference(const std::array<double, 4>& phi) {
  return std::hypot(0.5 * (phi[0] - phi[3]), phi[1]);
}

// A contact that is not bonded carries no tension.
double carried_overlap(const ContactView& c) {
  return c.bonded ? c.overlap + c.bond_gap : std::max(c.overlap, 0.0);
}

double elastic_energy(const Problem& problem, const std::vector<ContactView>& contacts) {
  double energy = 0;
  const auto& radius = problem.packing->radius;
  for (const auto& c : contacts) {
    energy +=
        c.weight * problem.law->energy(radius[static_cast<std::size_t>(c.i)],
                                       radius[static_cast<std::size_t>(c.j)], carried_overlap(c),
                                       c.tangential_force, c.moment, c.bonded);
  }
  return energy;
}

double mean_rotation(const Problem& problem, const Configuration& at) {
  const auto n = problem.packing->size();
  if (at.coordinates.size() < 3 * n) return 0;
  // Copies of a frame turn alike and count once.
  std::vector<double> rotation(problem.space->nodes, 0.0);
  for (std::size_t p = 0; p < n; ++p) {
    rotation[static_cast<std::size_t>(problem.space->node[p])] = at.coordinates[2 * n + p];
  }
  double sum = 0;
  for (const double value : rotation) sum += value;
  return sum / static_cast<double>(rotation.size());
}

double escaped_particles(const Problem& problem, const Configuration& at) {
  const auto& packing = *problem.packing;
  if (!packing.frame) return 0;
  const auto n = packing.size();
  const auto centre = [&](std::size_t p) {
    return Point{at.coordinates[p], at.coordinates[n + p]};
  };
  std::vector<Point> polygon;
  for (const int q : packing.frame->boundary)
    polygon.push_back(centre(static_cast<std::size_t>(q)));
  double escaped = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const auto node = static_cast<std::size_t>(problem.space->node[p]);
    if (!problem.space->boundary[node] && !is_inside(polygon, centre(p))) ++escaped;
  }
  return escaped;
}

}  // namespace

std::vector<ContactView> contact_views(const Problem& problem, const Configuration& at) {
  const auto& packing = *problem.packing;
  const auto n = packing.size();
  const auto& f = at.deformation;
  const auto& h = packing.cell;
  const double* x = at.coordinates.data();
  std::vector<NeighbourPair> pairs;
  for (const auto& c : at.contacts) pairs.push_back({c.i, c.j, c.shift});
  std::vector<double> weights(pairs.size(), 1.0);
  if (packing.frame) weigh_copies(*problem.space, packing, pairs, weights);
  std::vector<ContactView> views;
  views.reserve(at.contacts.size());
  for (std::size_t k = 0; k < at.contacts.size(); ++k) {
    const auto& c = at.contacts[k];
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    ContactView view{};
    view.i = c.i;
    view.j = c.j;
    view.shift = {c.shift[0], c.shift[1]};
    const double sx = packing.frame ? 0 : h[0] * c.shift[0] + h[1] * c.shift[1];
    const double sy = packing.frame ? 0 : h[2] * c.shift[0] + h[3] * c.shift[1];
    view.branch_x = x[j] - x[i] + f[0] * sx + f[1] * sy;
    view.branch_y = x[n + j] - x[n + i] + f[2] * sx + f[3] * sy;
    view.overlap = packing.radius[i] + packing.radius[j] - std::hypot(view.branch_x, view.branch_y);
    view.bonded = c.bonded;
    view.bond_gap = at.bond_gaps.empty() ? 0 : at.bond_gaps[k];
    view.moment = at.moments.empty() ? 0 : at.moments[k];
    view.normal_force =
        problem.law->normal_force(packing.radius[i], packing.radius[j], carried_overlap(view));
    view.tangential_force = c.tangential_force;
    view.weight = weights[k];
    views.push_back(view);
  }
  return views;
}

int measure_count(const Problem& problem, grainlaw_measure what) {
  const int dimension = problem.packing->dimension;
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

void measure(const Problem& problem, const Configuration& at, grainlaw_measure what,
             double* value) {
  const auto& f = at.deformation;
  const double volume = problem.space->reference_volume * (f[0] * f[3] - f[1] * f[2]);
  const auto contacts = contact_views(problem, at);
  const auto copy = [&](const std::array<double, 4>& tensor) {
    std::copy(tensor.begin(), tensor.end(), value);
  };
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
    case GRAINLAW_ANISOTROPY: {
      // The eigenvalues are 1/2 +- d: the fabric's trace is 1.
      const double d = half_difference(fabric(contacts));
      *value = (0.5 + d) / std::max(0.5 - d, 0.0) - 1;
      return;
    }
    case GRAINLAW_FABRIC_INTENSITY:
      // sqrt(1/2 Fa : Fa) of Fa = 4 dev fabric, with dev fabric : dev fabric = 2 d^2.
      *value = 4 * half_difference(fabric(contacts));
      return;
    case GRAINLAW_MEAN_OVERLAP: {
      double sum = 0;
      for (const auto& c : contacts) sum += c.weight * c.overlap;
      *value = contacts.empty() ? 0 : sum / weighted_number(contacts);
      return;
    }
    case GRAINLAW_MEAN_ROTATION:
      *value = mean_rotation(problem, at);
      return;
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
      return copy({f[0], f[1], f[2], f[3]});
    case GRAINLAW_ESCAPED_PARTICLES:
      *value = escaped_particles(problem, at);
      return;
  }
}

}  // namespace grainlaw

// Contact forces on coordinates and forces that are component-major, for tests of few discs.
#pragma once

#include "plane.hpp"

#include "contact/contact_forces.hpp"
#include "contact/contact_list.hpp"
#include "contact/contact_point.hpp"

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace grainlaw::core::test {

inline std::vector<ParticleRecord> records(std::span<const double> z,
                                           std::span<const double> radius) {
  const std::size_t n = radius.size();
  std::vector<ParticleRecord> result(n);
  for (std::size_t p = 0; p < n; ++p) {
    const double rotation = z.size() > 2 * n ? z[2 * n + p] : 0;
    result[p] = {z[p], z[n + p], radius[p] * rotation, radius[p]};
  }
  return result;
}

// Every particle a node of its own.
inline void build(std::span<const NeighbourPair> pairs, std::span<const double> radius,
                  const ContactLaw& law, const std::array<double, 4>& cell,
                  const HistoryStart& start, ContactList& list) {
  std::vector<int> node(radius.size());
  std::iota(node.begin(), node.end(), 0);
  build_contacts<2>(pairs, {}, radius, node, radius.size(), law, cell, start, list);
}

// Forces and moments on the particles, as many components as z has.
inline std::vector<double> forces(std::span<const double> z, std::span<const double> radius,
                                  const ContactLaw& law, ContactList& list) {
  const std::size_t n = radius.size();
  std::vector<ForceRecord> sums(n);
  evaluate_contacts<2>(records(z, radius), law, list, sums);
  std::vector<double> result(z.size());
  for (std::size_t p = 0; p < n; ++p) {
    result[p] = sums[p].x;
    result[n + p] = sums[p].y;
    if (z.size() > 2 * n) result[2 * n + p] = sums[p].roll * radius[p];
  }
  return result;
}

}  // namespace grainlaw::core::test

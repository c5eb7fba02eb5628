#include "contact/contact_list.hpp"

#include "base/capacity.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

template <int D>
void ContactList<D>::resize(std::size_t contacts, bool weighted, double radius,
                            const ContactLaw& law) {
  count = contacts;
  rotates_far = false;
  const std::size_t padded = (contacts + group - 1) / group * group;
  resize_with_capacity(forces, padded);
  resize_with_capacity(stiffness, padded);
  const auto fit = [&](auto& column, auto filling) {
    resize_with_capacity(column, padded);
    std::fill(column.begin() + static_cast<std::ptrdiff_t>(contacts), column.end(), filling);
  };
  // Padding: a particle beside itself at twice its diameter, without stiffness.
  fit(i, 0);
  fit(j, 0);
  for (std::size_t k = 0; k < D; ++k) {
    fit(shift[k], 0.0);
    fit(offset[k], k == 0 ? 4 * radius : 0.0);
    fit(start_normal[k], k == 0 ? 1.0 : 0.0);
  }
  for (auto& component : start_force) fit(component, 0.0);
  for (auto* column : {&normal_stiffness, &tangential_stiffness, &start_roll}) fit(*column, 0.0);
  fit(reach, 2 * radius);
  fit(inverse_reach, 0.5 / radius);
  fit(lever_i, 0.5);
  // Columns of other laws are cleared.
  for (auto* column :
       {&bond_capacity, &rest, &bending_stiffness, &rolling_length, &torsion_stiffness,
        &twisting_length, &inverse_radius_i, &inverse_radius_j}) {
    column->clear();
  }
  for (auto* columns : {&start_spin, &start_moment}) {
    for (auto& component : *columns) component.clear();
  }
  if (law.bonds()) {
    fit(bond_capacity, 0.0);
    fit(rest, 2 * radius);
  }
  if (law.moments()) {
    for (auto* column : {&bending_stiffness, &rolling_length}) fit(*column, 0.0);
    for (auto* columns : {&start_spin, &start_moment}) {
      for (auto& component : *columns) fit(component, 0.0);
    }
    if constexpr (D == 3) {
      fit(torsion_stiffness, 0.0);
      fit(twisting_length, 0.0);
      resize_with_capacity(moments, padded);
    }
    fit(inverse_radius_i, 1 / radius);
    fit(inverse_radius_j, 1 / radius);
  }
  if (weighted) {
    fit(weight, 1.0);
  } else {
    weight.clear();
  }
}

template <int D>
void build_contacts(std::span<const NeighbourPair<D>> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, std::span<const int> node, std::size_t nodes,
                    const ContactLaw& law, const Tensor<D>& cell, const HistoryStart<D>& start,
                    ContactList<D>& list) {
  const std::size_t n = radius.size();
  const double* x = start.coordinates.data();
  const double* rotation = law.rotating() ? x + D * n : nullptr;
  const double ratio = law.tangential() ? law.ratio : 0;
  const bool bonds = law.bonds();
  const ContactLaw of_bonds = law.of_bonds();
  const bool moments = law.moments();
  list.resize(pairs.size(), !pair_weights.empty(), radius.empty() ? 1 : radius[0], law);
  std::size_t h = 0;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& pair = pairs[c];
    const auto p = static_cast<std::size_t>(pair.i);
    const auto q = static_cast<std::size_t>(pair.j);
    const Vec<D> shift = vec_of<D>(pair.shift);
    const double weight = pair_weights.empty() ? 1.0 : pair_weights[c];
    list.i[c] = pair.i;
    list.j[c] = pair.j;
    const Vec<D> offset = product<D>(cell, shift);
    for (std::size_t k = 0; k < D; ++k) {
      list.shift[k][c] = shift[k];
      list.offset[k][c] = offset[k];
    }
    list.reach[c] = radius[p] + radius[q];
    list.inverse_reach[c] = 1 / list.reach[c];
    list.lever_i[c] = radius[p] / list.reach[c];
    list.normal_stiffness[c] = weight * law.coefficient(radius[p], radius[q]);
    list.tangential_stiffness[c] = ratio * list.normal_stiffness[c];
    if (!pair_weights.empty()) list.weight[c] = weight;

    const Vec<D> l = branch<D>(x, n, p, q, start.cell, shift);
    const double d = length<D>(l);
    for (std::size_t k = 0; k < D; ++k) {
      list.start_normal[k][c] = d > 0 ? l[k] / d : (k == 0 ? 1 : 0);
    }
    if constexpr (D == 2) {
      list.start_roll[c] = rotation ? radius[p] * rotation[p] + radius[q] * rotation[q] : 0;
    }

    while (h < start.contacts.size() && key_of(start.contacts[h]) < key_of(pair)) ++h;
    const bool known = h < start.contacts.size() && key_of(start.contacts[h]) == key_of(pair);
    for (std::size_t k = 0; k < list.start_force.size(); ++k) {
      list.start_force[k][c] = known ? weight * start.contacts[h].tangential_force[k] : 0;
    }
    if (law.plain()) continue;

    const bool bonded = bonds && known && start.contacts[h].bonded;
    if (bonded) {
      list.normal_stiffness[c] = weight * of_bonds.coefficient(radius[p], radius[q]);
      list.tangential_stiffness[c] = of_bonds.ratio * list.normal_stiffness[c];
    }
    if (bonds) {
      list.bond_capacity[c] = bonded ? ContactList<D>::unbreakable : 0;
      list.rest[c] = list.reach[c] + (bonded && !start.gaps.empty() ? start.gaps[h] : 0);
    }
    if (moments) {
      constexpr std::size_t spins = Dimension<D>::spins;
      const double rolling = law.rolling_ratio(radius[p], radius[q]);
      list.bending_stiffness[c] =
          bonded ? weight * law.bond.bending_stiffness : rolling * list.tangential_stiffness[c];
      list.rolling_length[c] =
          law.rolls() ? law.rolling.friction * law.common_radius(radius[p], radius[q]) : 0;
      if constexpr (D == 3) {
        const double twisting = law.twisting_ratio(radius[p], radius[q]);
        list.torsion_stiffness[c] =
            bonded ? weight * law.bond.torsion_stiffness : twisting * list.tangential_stiffness[c];
        list.twisting_length[c] =
            law.twists() ? law.rolling.twisting_friction * law.common_radius(radius[p], radius[q])
                         : 0;
      }
      list.inverse_radius_i[c] = 1 / radius[p];
      list.inverse_radius_j[c] = 1 / radius[q];
      for (std::size_t k = 0; k < spins; ++k) {
        list.start_spin[k][c] = rotation[k * n + q] - rotation[k * n + p];
        list.start_moment[k][c] =
            known && !start.moments.empty() ? weight * start.moments[spins * h + k] : 0;
      }
    }
    if (law.hertzian()) {
      const double overlap = list.reach[c] - d;
      const double scale = overlap > 0 ? 1 / std::sqrt(std::sqrt(overlap)) : 0;
      for (auto& component : list.start_force) component[c] *= scale;
      if (!moments) continue;
      for (auto& component : list.start_moment) component[c] *= scale;
    }
  }
  if (moments) {
    resize_with_capacity(list.inverse_node_radius, nodes);
    if constexpr (D == 3) resize_with_capacity(list.node_moments, nodes);
    for (std::size_t p = 0; p < n; ++p) {
      list.inverse_node_radius[static_cast<std::size_t>(node[p])] = 1 / radius[p];
    }
  }
  const std::span<const std::int32_t> i(list.i), j(list.j);
  list.sums.arrange(i.first(pairs.size()), j.first(pairs.size()), node, nodes);
}

#define GRAINLAW_FOR(D)                                                                        \
  template struct ContactList<D>;                                                              \
  template void build_contacts<D>(std::span<const NeighbourPair<D>>, std::span<const double>,  \
                                  std::span<const double>, std::span<const int>, std::size_t,  \
                                  const ContactLaw&, const Tensor<D>&, const HistoryStart<D>&, \
                                  ContactList<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

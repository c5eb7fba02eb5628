#include "contact/contact_list.hpp"

#include "base/room.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainlaw {

void ContactList::resize(std::size_t contacts, bool weighted, double radius,
                         const ContactLaw& law) {
  count = contacts;
  turns_far = false;
  const std::size_t padded = (contacts + group - 1) / group * group;
  resize_with_room(forces, padded);
  const auto fit = [&](auto& column, auto filling) {
    resize_with_room(column, padded);
    std::fill(column.begin() + static_cast<std::ptrdiff_t>(contacts), column.end(), filling);
  };
  // Filled up with a particle beside itself at twice its diameter, without stiffness.
  fit(i, 0);
  fit(j, 0);
  for (auto* column : {&shift_x, &shift_y, &offset_y, &normal_stiffness, &tangential_stiffness,
                       &start_y, &start_roll, &start_force}) {
    fit(*column, 0.0);
  }
  fit(offset_x, 4 * radius);
  fit(reach, 2 * radius);
  fit(inverse_reach, 0.5 / radius);
  fit(lever_i, 0.5);
  fit(start_x, 1.0);
  // Other laws leave their columns behind.
  for (auto* column : {&hold, &rest, &bending_stiffness, &rolling_length, &start_spin,
                       &start_moment, &inverse_radius_i, &inverse_radius_j}) {
    column->clear();
  }
  if (law.bonds()) {
    fit(hold, 0.0);
    fit(rest, 2 * radius);
  }
  if (law.moments()) {
    for (auto* column : {&bending_stiffness, &rolling_length, &start_spin, &start_moment}) {
      fit(*column, 0.0);
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

void build_contacts(std::span<const NeighbourPair> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, std::span<const int> node, std::size_t nodes,
                    const ContactLaw& law, const std::array<double, 4>& cell,
                    const HistoryStart& start, ContactList& list) {
  const std::size_t n = radius.size();
  const double* x = start.coordinates.data();
  const double* y = x + n;
  const double* rotation = law.rotating() ? y + n : nullptr;
  const double ratio = law.tangential() ? law.ratio : 0;
  const bool bonds = law.bonds();
  const bool moments = law.moments();
  list.resize(pairs.size(), !pair_weights.empty(), radius.empty() ? 1 : radius[0], law);
  std::size_t h = 0;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& pair = pairs[c];
    const auto key = std::tie(pair.i, pair.j, pair.shift);
    const auto p = static_cast<std::size_t>(pair.i);
    const auto q = static_cast<std::size_t>(pair.j);
    const double s0 = pair.shift[0];
    const double s1 = pair.shift[1];
    const double weight = pair_weights.empty() ? 1.0 : pair_weights[c];
    list.i[c] = pair.i;
    list.j[c] = pair.j;
    list.shift_x[c] = s0;
    list.shift_y[c] = s1;
    list.offset_x[c] = cell[0] * s0 + cell[1] * s1;
    list.offset_y[c] = cell[2] * s0 + cell[3] * s1;
    list.reach[c] = radius[p] + radius[q];
    list.inverse_reach[c] = 1 / list.reach[c];
    list.lever_i[c] = radius[p] / list.reach[c];
    list.normal_stiffness[c] = weight * law.coefficient(radius[p], radius[q]);
    list.tangential_stiffness[c] = ratio * list.normal_stiffness[c];
    if (!pair_weights.empty()) list.weight[c] = weight;

    const double lx = x[q] - x[p] + start.cell[0] * s0 + start.cell[1] * s1;
    const double ly = y[q] - y[p] + start.cell[2] * s0 + start.cell[3] * s1;
    const double d = std::hypot(lx, ly);
    list.start_x[c] = d > 0 ? lx / d : 1;
    list.start_y[c] = d > 0 ? ly / d : 0;
    list.start_roll[c] = rotation ? radius[p] * rotation[p] + radius[q] * rotation[q] : 0;

    while (h < start.contacts.size() &&
           std::tie(start.contacts[h].i, start.contacts[h].j, start.contacts[h].shift) < key) {
      ++h;
    }
    const bool known =
        h < start.contacts.size() &&
        std::tie(start.contacts[h].i, start.contacts[h].j, start.contacts[h].shift) == key;
    list.start_force[c] = known ? weight * start.contacts[h].tangential_force : 0;
    if (law.plain()) continue;

    const bool bonded = bonds && known && start.contacts[h].bonded;
    if (bonds) {
      list.hold[c] = bonded ? ContactList::held : 0;
      list.rest[c] = list.reach[c] + (bonded && !start.gaps.empty() ? start.gaps[h] : 0);
    }
    if (moments) {
      const double rolling = law.rolling_ratio(radius[p], radius[q]);
      list.bending_stiffness[c] =
          bonded ? weight * law.bond.bending_stiffness : rolling * list.tangential_stiffness[c];
      list.rolling_length[c] =
          law.rolls() ? law.rolling.friction * law.common_radius(radius[p], radius[q]) : 0;
      list.inverse_radius_i[c] = 1 / radius[p];
      list.inverse_radius_j[c] = 1 / radius[q];
      list.start_spin[c] = rotation[q] - rotation[p];
      list.start_moment[c] = known && !start.moments.empty() ? weight * start.moments[h] : 0;
    }
    if (law.hertzian()) {
      const double overlap = list.reach[c] - d;
      const double scale = overlap > 0 ? 1 / std::sqrt(std::sqrt(overlap)) : 0;
      list.start_force[c] *= scale;
      if (moments) list.start_moment[c] *= scale;
    }
  }
  if (moments) {
    resize_with_room(list.inverse_node_radius, nodes);
    for (std::size_t p = 0; p < n; ++p) {
      list.inverse_node_radius[static_cast<std::size_t>(node[p])] = 1 / radius[p];
    }
  }
  const std::span<const std::int32_t> i(list.i), j(list.j);
  list.sums.arrange(i.first(pairs.size()), j.first(pairs.size()), node, nodes);
}

}  // namespace grainlaw

#include "contact/contact_list.hpp"

#include "room.hpp"

#include <cmath>
#include <tuple>

namespace grainlaw {

void ContactList::resize(std::size_t count, bool weighted) {
  resize_with_room(i, count);
  resize_with_room(j, count);
  for (auto* column :
       {&shift_x, &shift_y, &reach, &lever_i, &normal_stiffness, &tangential_stiffness, &start_x,
        &start_y, &start_turn, &start_force, &force_x, &force_y, &couple}) {
    resize_with_room(*column, count);
  }
  resize_with_room(weight, weighted ? count : 0);
}

void build_contacts(std::span<const NeighbourPair> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, const ContactLaw& law,
                    const HistoryStart& start, ContactList& list) {
  const std::size_t n = radius.size();
  const double* x = start.coordinates.data();
  const double* y = x + n;
  const double* rotation = law.rotating() ? y + n : nullptr;
  const double ratio = law.tangential() ? law.ratio : 0;
  list.resize(pairs.size(), !pair_weights.empty());
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
    list.reach[c] = radius[p] + radius[q];
    list.lever_i[c] = radius[p] / list.reach[c];
    list.normal_stiffness[c] = weight * law.stiffness(radius[p], radius[q]);
    list.tangential_stiffness[c] = ratio * list.normal_stiffness[c];
    if (!pair_weights.empty()) list.weight[c] = weight;

    const double lx = x[q] - x[p] + start.cell[0] * s0 + start.cell[1] * s1;
    const double ly = y[q] - y[p] + start.cell[2] * s0 + start.cell[3] * s1;
    const double d = std::hypot(lx, ly);
    list.start_x[c] = d > 0 ? lx / d : 1;
    list.start_y[c] = d > 0 ? ly / d : 0;
    list.start_turn[c] =
        rotation ? list.lever_i[c] * rotation[p] + (1 - list.lever_i[c]) * rotation[q] : 0;

    while (h < start.contacts.size() &&
           std::tie(start.contacts[h].i, start.contacts[h].j, start.contacts[h].shift) < key) {
      ++h;
    }
    const bool known =
        h < start.contacts.size() &&
        std::tie(start.contacts[h].i, start.contacts[h].j, start.contacts[h].shift) == key;
    list.start_force[c] = known ? weight * start.contacts[h].tangential_force : 0;
  }
}

}  // namespace grainlaw

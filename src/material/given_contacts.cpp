#include "material/given_contacts.hpp"

#include "packing/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace grainlaw {

namespace {

using Key = std::tuple<std::int32_t, std::int32_t, std::array<std::int16_t, 2>>;

std::vector<NeighbourPair> near_pairs(const Material& material, double gap) {
  const auto& packing = material.packing;
  NeighbourSearch search;
  std::vector<NeighbourPair> pairs;
  search.find(packing.size(), packing.position.data(), packing.radius.data(),
              packing.frame ? nullptr : packing.cell.data(), gap, pairs);
  return pairs;
}

// R_i + R_j - |x_j - x_i + H shift| in the packing as given.
template <class Pair>
double given_overlap(const Packing& packing, const Pair& pair) {
  const auto i = static_cast<std::size_t>(pair.i);
  const auto j = static_cast<std::size_t>(pair.j);
  const auto n = packing.size();
  const auto& h = packing.cell;
  const double s0 = packing.frame ? 0 : pair.shift[0];
  const double s1 = packing.frame ? 0 : pair.shift[1];
  return packing.radius[i] + packing.radius[j] -
         std::hypot(packing.position[j] - packing.position[i] + h[0] * s0 + h[1] * s1,
                    packing.position[n + j] - packing.position[n + i] + h[2] * s0 + h[3] * s1);
}

double mean_radius(const Packing& packing) {
  double sum = 0;
  for (const double r : packing.radius) sum += r / static_cast<double>(packing.size());
  return sum;
}

}  // namespace

void add_bonds_and_moments(const Material& material, Configuration& given) {
  const auto& packing = material.packing;
  const auto& law = material.law;
  const bool named = packing.names_bonds;
  struct Extra {
    double moment = 0, gap = 0;
  };
  std::map<Key, std::pair<ContactHistory, Extra>> contacts;
  for (const auto& c : given.contacts) contacts[{c.i, c.j, c.shift}].first = c;
  if (law.bonds() && !named) {
    constexpr double touch = 1e-9;  // of the radius: discs that rounding holds apart touch too
    const double reach = std::max(law.bond.gap, touch * mean_radius(packing));
    for (const auto& pair : near_pairs(material, reach)) {
      auto& [contact, extra] = contacts[{pair.i, pair.j, pair.shift}];
      contact.i = pair.i;
      contact.j = pair.j;
      contact.shift = pair.shift;
      contact.bonded = true;
      extra.gap = std::max(-given_overlap(packing, pair), 0.0);
    }
  }
  for (const auto& c : packing.contacts) {
    const Key key{
        c.i, c.j, {static_cast<std::int16_t>(c.shift[0]), static_cast<std::int16_t>(c.shift[1])}};
    const auto found = contacts.find(key);
    if (found == contacts.end()) continue;  // named from the other side: files never are
    auto& [contact, extra] = found->second;
    extra.moment = c.moment;
    if (!named || !law.bonds()) continue;
    contact.bonded = c.bonded;
    extra.gap = c.bond_gap;
  }
  const bool gaps =
      law.bonds() &&
      (law.bond.gap > 0 || std::any_of(contacts.begin(), contacts.end(),
                                       [](const auto& c) { return c.second.second.gap > 0; }));
  given.contacts.clear();
  for (const auto& [key, contact] : contacts) {
    given.contacts.push_back(contact.first);
    if (law.moments()) given.moments.push_back(contact.second.moment);
    if (gaps) given.bond_gaps.push_back(contact.second.gap);
  }
}

double mean_overlap(const Material& material) {
  const auto& radius = material.packing.radius;
  double sum = 0;
  double number = 0;
  for (const auto& pair : near_pairs(material, 0)) {
    const double r = ContactLaw::common_radius(radius[static_cast<std::size_t>(pair.i)],
                                               radius[static_cast<std::size_t>(pair.j)]);
    sum += given_overlap(material.packing, pair) / r;
    ++number;
  }
  constexpr double rounding = 1e-12;
  return sum > rounding * number ? sum / number : ContactLaw{}.typical_overlap;
}

double unloaded_force_scale(const Material& material) {
  const double r = mean_radius(material.packing);
  return 1e-3 * r * material.law.stiffness(r, r);
}

}  // namespace grainlaw

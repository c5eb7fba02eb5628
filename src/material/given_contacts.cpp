#include "material/given_contacts.hpp"

#include "packing/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace grainlaw::core {

namespace {

template <int D>
using Key =
    std::tuple<std::int32_t, std::int32_t, std::array<std::int16_t, static_cast<std::size_t>(D)>>;

constexpr std::size_t shift_of_key = 2;

template <int D>
std::vector<NeighbourPair<D>> near_pairs(const Material<D>& material, double gap) {
  const auto& packing = material.packing;
  std::vector<NeighbourPair<D>> pairs;
  NeighbourSearch<D>().find(packing.size(), packing.position.data(), packing.radius.data(),
                            packing.frame ? nullptr : packing.cell.data(), gap, pairs);
  return pairs;
}

// Data of a contact outside its history.
template <int D>
struct Extra {
  ContactHistory<D> history;
  std::array<double, Dimension<D>::spins> moment{};
  double gap = 0;
};

}  // namespace

template <int D>
void add_bonds_and_moments(const Material<D>& material, Configuration<D>& given) {
  const auto& packing = material.packing;
  const auto& law = material.law;
  const bool named = packing.names_bonds;
  std::map<Key<D>, Extra<D>> contacts;
  for (const auto& c : given.contacts) contacts[key_of(c)].history = c;
  if (law.bonds() && !named) {
    constexpr double touch = 1e-9;  // relative to the radius, for particles separated by rounding
    const double reach = std::max(law.bond.gap, touch * mean_radius(packing.radius));
    for (const auto& pair : near_pairs<D>(material, reach)) {
      auto& contact = contacts[key_of(pair)];
      contact.history.i = pair.i;
      contact.history.j = pair.j;
      contact.history.shift = pair.shift;
      contact.history.bonded = true;
      contact.gap = std::max(-given_overlap<D>(packing, pair), 0.0);
    }
  }
  for (const auto& c : packing.contacts) {
    Key<D> key{c.i, c.j, {}};
    for (std::size_t k = 0; k < D; ++k) {
      std::get<shift_of_key>(key)[k] = static_cast<std::int16_t>(c.shift[k]);
    }
    const auto found = contacts.find(key);
    if (found == contacts.end()) continue;  // named from j, as no file is
    auto& contact = found->second;
    contact.moment = given_moment<D>(c);
    if (!named || !law.bonds()) continue;
    contact.history.bonded = c.bonded;
    contact.gap = c.bond_gap;
  }
  const auto has_gap = [](const auto& c) { return c.second.gap > 0; };
  const bool gaps =
      law.bonds() && (law.bond.gap > 0 || std::any_of(contacts.begin(), contacts.end(), has_gap));
  given.contacts.clear();
  for (const auto& [key, contact] : contacts) {
    given.contacts.push_back(contact.history);
    if (law.moments()) {
      given.moments.insert(given.moments.end(), contact.moment.begin(), contact.moment.end());
    }
    if (gaps) given.bond_gaps.push_back(contact.gap);
  }
}

template <int D>
double mean_overlap(const Material<D>& material) {
  const auto& radius = material.packing.radius;
  double sum = 0;
  double number = 0;
  for (const auto& pair : near_pairs<D>(material, 0)) {
    const double r = ContactLaw::common_radius(radius[static_cast<std::size_t>(pair.i)],
                                               radius[static_cast<std::size_t>(pair.j)]);
    sum += given_overlap<D>(material.packing, pair) / r;
    ++number;
  }
  constexpr double rounding = 1e-12;
  return sum > rounding * number ? sum / number : ContactLaw{}.typical_overlap;
}

template <int D>
double unloaded_force_scale(const Material<D>& material) {
  const double r = mean_radius(material.packing.radius);
  return 1e-3 * r * material.law.of_bonds().stiffness(r, r);
}

#define GRAINLAW_FOR(D)                                                       \
  template void add_bonds_and_moments(const Material<D>&, Configuration<D>&); \
  template double mean_overlap(const Material<D>&);                           \
  template double unloaded_force_scale(const Material<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

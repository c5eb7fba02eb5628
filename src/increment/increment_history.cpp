// Where the history of contacts starts, and what ends there: the parts of Increment that outlast an
// equilibrium.
#include "base/room.hpp"
#include "contact/contact_point.hpp"
#include "contact/frictional.hpp"
#include "increment/increment.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainlaw {

double Increment::chance_force() const {
  constexpr double loosest = 1e-4;  // a coarse solution still has real contacts that carry little
  return std::max(std::min(problem->tolerance, loosest) * relative_scale(), rounding_force_);
}

bool Increment::carries(std::size_t c) const {
  if (contacts.bonded(c)) return true;
  if (released_) return false;
  return normal_force(contacts, c, overlap(c), *problem->law) > 10 * chance_force();
}

bool Increment::bears() const {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (carries(c)) return true;
  }
  return false;
}

// What the springs hold less what the prescribed stresses have given: at the given F and those
// stresses nothing else gives energy.
double Increment::potential_energy() const {
  const auto& space = *problem->space;
  double energy = stored_energy(contacts, coordinates, particles(), *problem->law);
  for (std::size_t k = 0; k < 4; ++k) {
    if (space.found[k]) energy -= space.reference_volume * space.stress[k] * deformation[k];
  }
  return energy;
}

void Increment::advance_contacts_and_history() {
  load_records();
  const auto& law = *problem->law;
  dissipated += advance_contacts(records, law, contacts, forces);
  if (after_break_) dissipated = break_dissipated_ + break_energy_ - potential_energy();
  const bool gaps = !history_gaps.empty();
  history.clear();
  history_moments.clear();
  history_gaps.clear();
  if (history.capacity() < pairs.size()) history.reserve(pairs.capacity());
  if (law.moments()) history_moments.reserve(history.capacity());
  if (gaps) history_gaps.reserve(history.capacity());
  const bool tangential = law.tangential();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!carries(c)) continue;
    const double depth = overlap(c);
    const double scale = start_scale(depth, law);
    const double force = tangential ? contacts.start_force[c] * scale : 0.0;
    const double bound = law.friction * normal_force(contacts, c, depth, law);
    const bool bonded = contacts.bonded(c);
    const double weight = contacts.weight_of(c);
    history.push_back({contacts.i[c], contacts.j[c], pairs[c].shift,
                       tangential && !bonded && std::abs(force) >= bound - chance_force(), bonded,
                       force / weight});
    if (law.moments()) history_moments.push_back(contacts.start_moment[c] * scale / weight);
    if (gaps) history_gaps.push_back(contacts.rest[c] - contacts.reach[c]);
  }
}

void Increment::advance_history() {
  advance_contacts_and_history();
  start = coordinates;
  start_deformation = deformation;
  build_list();
}

void Increment::continue_history() {
  advance_contacts_and_history();
  carry_start();
  start_deformation = deformation;
  build_list();
}

void Increment::find_held(std::vector<unsigned char>& held) const {
  const auto& space = *problem->space;
  held.assign(nodes(), 0);
  for (std::size_t q = 0; q < space.fixed.size(); ++q) held[q] = space.fixed[q] & fixed_translation;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!carries(c)) continue;
    held[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.i[c])])] =
        held[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.j[c])])] =
            fixed_translation;
  }
}

// Turns stay as they are: a disc is the same however far it has turned.
void Increment::carry_start() {
  const auto n = particles();
  const auto& node = problem->space->node;
  find_held(held_);
  carried_start_.assign(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(2 * n));
  carry_affinely(start_deformation, deformation, carried_start_);
  start = coordinates;
  for (std::size_t k = 0; k < 2; ++k) {
    const unsigned char bit = k == 0 ? fixed_x : fixed_y;
    const double* carried = carried_start_.data() + k * n;
    const auto held = [&](std::size_t p) {
      return (held_[static_cast<std::size_t>(node[p])] & bit) != 0;
    };
    double sum = 0;
    double count = 0;
    for (std::size_t p = 0; p < n; ++p) {
      if (!held(p)) continue;
      sum += coordinates[k * n + p] - carried[p];
      ++count;
    }
    if (count == static_cast<double>(n)) continue;
    const double mean = count > 0 ? sum / count : 0;
    for (std::size_t p = 0; p < n; ++p) {
      if (!held(p)) start[k * n + p] = carried[p] + mean;
    }
  }
}

// Eq. 8 of Liu, Bosco & Suiker (2017), 1 at failure; without a bond 0.
double Increment::bond_load(std::size_t c) const {
  if (!contacts.bonded(c)) return 0;
  const auto& law = *problem->law;
  const auto point = contact_point(contacts, c, coordinates, particles(), law);
  double load = -point.normal_force / law.bond.normal_strength +
                std::abs(point.tangential_force) / law.bond.tangential_strength;
  if (law.bond.bending_strength > 0 && law.moments()) {
    load += std::abs(contact_moment(contacts, c, point, coordinates, particles(), law).moment) /
            law.bond.bending_strength;
  }
  return load / contacts.weight_of(c);
}

double Increment::worst_bond() const {
  double worst = 0;
  if (!problem->law->bonds()) return worst;
  for (std::size_t c = 0; c < contacts.size(); ++c) worst = std::max(worst, bond_load(c));
  return worst;
}

bool Increment::break_bonds() {
  if (!overloads_bonds()) return false;
  const double energy = potential_energy();
  continue_history();
  after_break_ = true;
  break_energy_ = energy;
  break_dissipated_ = dissipated;
  const double worst = worst_bond();
  const double limit = std::min(worst, 0.5 * (1 + worst));
  std::size_t h = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!contacts.bonded(c)) continue;
    const auto key = std::tie(contacts.i[c], contacts.j[c], pairs[c].shift);
    while (std::tie(history[h].i, history[h].j, history[h].shift) != key) ++h;
    if (bond_load(c) < limit) continue;
    history[h].bonded = false;
    broken_bonds += contacts.weight_of(c);
  }
  build_list();
  return true;
}

void Increment::export_to(const Configuration& from, Configuration& to) const {
  const auto n = particles();
  to.deformation = {deformation[0], deformation[1], deformation[2], deformation[3]};
  to.coordinates = coordinates;
  const auto moved = drift();
  for (std::size_t k = 0; k < 2; ++k) {
    if (problem->space->anchor[k] < 0) continue;
    for (std::size_t p = 0; p < n; ++p) to.coordinates[k * n + p] -= moved[k];
  }
  for (std::size_t k = 2 * n; k < coordinates.size(); ++k) {
    to.coordinates[k] += from.coordinates[k];
  }
  copy_with_room(history, to.contacts, little);
  copy_with_room(history_moments, to.moments, little);
  copy_with_room(history_gaps, to.bond_gaps, little);
  to.dissipated = from.dissipated + dissipated;
  to.broken_bonds = from.broken_bonds + broken_bonds;
}

}  // namespace grainlaw

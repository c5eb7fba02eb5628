// Where the history of contacts starts, and what ends there: the parts of Increment that outlast an
// equilibrium.
#include "base/constants.hpp"
#include "base/room.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_point.hpp"
#include "increment/increment.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

double magnitude_of(double force) { return std::abs(force); }
double magnitude_of(const std::array<double, 1>& force) { return std::abs(force[0]); }
double magnitude_of(const Vec<3>& force) { return std::sqrt(square<3>(force)); }

}  // namespace

template <int D>
double Increment<D>::chance_force() const {
  return std::max(std::min(problem->tolerance, tuned::largest_chance) * relative_scale(),
                  rounding_force_);
}

template <int D>
bool Increment<D>::carries(std::size_t c) const {
  if (contacts.bonded(c)) return true;
  if (released_) return false;
  return normal_force(contacts, c, overlap(c), *problem->law) >
         tuned::more_than_chance * chance_force();
}

template <int D>
bool Increment<D>::bears() const {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (carries(c)) return true;
  }
  return false;
}

// What the springs hold less what the prescribed stresses have given: at the given F and those
// stresses nothing else gives energy.
template <int D>
double Increment<D>::potential_energy() const {
  const auto& space = *problem->space;
  double energy = stored_energy(contacts, coordinates, particles(), *problem->law);
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) energy -= space.reference_volume * space.stress[k] * deformation[k];
  }
  return energy;
}

template <int D>
void Increment<D>::advance_contacts_and_history() {
  load_records();
  const auto& law = *problem->law;
  dissipated += advance_contacts<D>(records, law, contacts, forces);
  restart_turns();
  if (after_break_) dissipated = break_dissipated_ + break_energy_ - potential_energy();
  const bool gaps = !history_gaps.empty();
  history.clear();
  history_moments.clear();
  history_gaps.clear();
  if (history.capacity() < pairs.size()) history.reserve(pairs.capacity());
  if (law.moments()) history_moments.reserve(spins * history.capacity());
  if (gaps) history_gaps.reserve(history.capacity());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!carries(c)) continue;
    const double depth = overlap(c);
    const double scale = start_scale(depth, law);
    const double weight = contacts.weight_of(c);
    ContactHistory<D>& kept = history.emplace_back();
    kept.i = contacts.i[c];
    kept.j = contacts.j[c];
    kept.shift = pairs[c].shift;
    kept.bonded = contacts.bonded(c);
    if (law.tangential()) {
      std::array<double, Dimension<D>::tangents> force{};
      for (std::size_t k = 0; k < force.size(); ++k) {
        force[k] = contacts.start_force[k][c] * scale;
        kept.tangential_force[k] = force[k] / weight;
      }
      const double bound = law.friction * normal_force(contacts, c, depth, law);
      kept.sliding = !kept.bonded && magnitude_of(force) >= bound - chance_force();
    }
    if (law.moments()) {
      for (const auto& moment : contacts.start_moment) {
        history_moments.push_back(moment[c] * scale / weight);
      }
    }
    if (gaps) history_gaps.push_back(contacts.rest[c] - contacts.reach[c]);
  }
}

template <int D>
void Increment<D>::advance_history() {
  advance_contacts_and_history();
  start = coordinates;
  start_deformation = deformation;
  build_list();
}

template <int D>
void Increment<D>::continue_history() {
  advance_contacts_and_history();
  carry_start();
  start_deformation = deformation;
  build_list();
}

template <int D>
void Increment<D>::find_held(std::vector<unsigned char>& held) const {
  const auto& space = *problem->space;
  held.assign(nodes(), 0);
  for (std::size_t q = 0; q < space.fixed.size(); ++q)
    held[q] = space.fixed[q] & fixed_translation<D>;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!carries(c)) continue;
    held[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.i[c])])] =
        held[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.j[c])])] =
            fixed_translation<D>;
  }
}

// Turns stay as they are: a particle is the same however far it has turned.
template <int D>
void Increment<D>::carry_start() {
  const auto n = particles();
  const auto& node = problem->space->node;
  find_held(held_);
  carried_start_.assign(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(dim * n));
  carry_affinely(start_deformation, deformation, carried_start_);
  start = coordinates;
  for (std::size_t k = 0; k < dim; ++k) {
    const double* carried = carried_start_.data() + k * n;
    const auto held = [&](std::size_t p) {
      return (held_[static_cast<std::size_t>(node[p])] & fixed_bit(k)) != 0;
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
template <int D>
double Increment<D>::bond_load(std::size_t c) const {
  if (!contacts.bonded(c)) return 0;
  const auto& law = *problem->law;
  const auto point = contact_point(contacts, c, coordinates, particles(), law);
  double load = -point.normal_force / law.bond.normal_strength +
                magnitude_of(point.tangential_force) / law.bond.tangential_strength;
  if (law.bond.bending_strength > 0 && law.moments()) {
    load += std::abs(contact_moment(contacts, c, point, coordinates, particles(), law).moment) /
            law.bond.bending_strength;
  }
  return load / contacts.weight_of(c);
}

template <int D>
double Increment<D>::worst_bond() const {
  double worst = 0;
  if (!problem->law->bonds()) return worst;
  for (std::size_t c = 0; c < contacts.size(); ++c) worst = std::max(worst, bond_load(c));
  return worst;
}

template <int D>
bool Increment<D>::break_bonds() {
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
    while (key_of(history[h]) != key_of(pairs[c])) ++h;
    if (bond_load(c) < limit) continue;
    history[h].bonded = false;
    broken_bonds += contacts.weight_of(c);
  }
  build_list();
  return true;
}

template <int D>
void Increment<D>::export_to(const Configuration<D>& from, Configuration<D>& to) const {
  const auto n = particles();
  to.deformation = deformation;
  to.coordinates = coordinates;
  const auto moved = drift();
  for (std::size_t k = 0; k < dim; ++k) {
    if (problem->space->anchor[k] < 0) continue;
    for (std::size_t p = 0; p < n; ++p) to.coordinates[k * n + p] -= moved[k];
  }
  turned_.export_to(n, from.coordinates, to.coordinates);
  copy_with_room(history, to.contacts, little);
  copy_with_room(history_moments, to.moments, little);
  copy_with_room(history_gaps, to.bond_gaps, little);
  to.dissipated = from.dissipated + dissipated;
  to.broken_bonds = from.broken_bonds + broken_bonds;
}

template class Increment<2>;
template class Increment<3>;

}  // namespace grainlaw::core

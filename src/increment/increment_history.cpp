// Functions of Increment that outlast an equilibrium: start of the contact history, and losses.
#include "base/constants.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_point.hpp"
#include "increment/increment.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

template <int D>
bool Increment<D>::bears_load(std::size_t c) const {
  if (contacts_.bonded(c)) return true;
  if (released_) return false;
  return normal_force(contacts_, c, overlap(c), *problem_->law) >
         tuned::more_than_chance * scale_.chance();
}

template <int D>
bool Increment<D>::loaded() const {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (bears_load(c)) return true;
  }
  return false;
}

// Energy of the springs less the work of the prescribed stresses [J]. Nothing else supplies energy
// at the given F.
template <int D>
double Increment<D>::potential_energy() const {
  const auto& space = *problem_->space;
  double energy =
      stored_energy(contacts_, motion_.coordinates(), problem_->particles(), *problem_->law);
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k])
      energy -= space.reference_volume * space.stress[k] * motion_.deformation()[k];
  }
  return energy;
}

template <int D>
void Increment<D>::advance_contacts_and_history() {
  motion_.load_records();
  const auto& law = *problem_->law;
  losses_.dissipate(advance_contacts<D>(motion_.records(), law, contacts_, forces_));
  motion_.restart_rotations();
  if (losses_.after_break()) losses_.fall_to(potential_energy());
  history_.clear(pairs(), law);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (bears_load(c)) history_.add(contacts_, c, pairs()[c], overlap(c), scale_.chance(), law);
  }
}

template <int D>
void Increment<D>::advance_history() {
  advance_contacts_and_history();
  motion_.start_here();
  build_list();
}

template <int D>
void Increment<D>::continue_history() {
  advance_contacts_and_history();
  find_supported(supported_);
  motion_.start_here(supported_);
  build_list();
}

template <int D>
void Increment<D>::find_supported(std::vector<unsigned char>& supported) const {
  const auto& space = *problem_->space;
  supported.assign(problem_->nodes(), 0);
  if (motion_.drag().acts())
    return std::fill(supported.begin(), supported.end(), fixed_translation<D>);
  for (std::size_t q = 0; q < space.fixed.size(); ++q)
    supported[q] = space.fixed[q] & fixed_translation<D>;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (!bears_load(c)) continue;
    supported[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts_.i[c])])] =
        supported[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts_.j[c])])] =
            fixed_translation<D>;
  }
}

template <int D>
int Increment<D>::released_particle() {
  const auto& space = *problem_->space;
  supported_.assign(problem_->nodes(), 0);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (overlap(c) <= 0) continue;
    supported_[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts_.i[c])])] = 1;
    supported_[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts_.j[c])])] = 1;
  }
  for (const auto& average : space.average) {
    for (const auto q : average.node) {
      if (supported_[static_cast<std::size_t>(q)]) continue;
      return static_cast<int>(std::find(space.node.begin(), space.node.end(), q) -
                              space.node.begin());
    }
  }
  return -1;
}

template <int D>
bool Increment<D>::collapsed() {
  if (!problem_->space->averages()) return false;
  return scale_.mean_force() < problem_->force_floor || released_particle() >= 0;
}

template <int D>
bool Increment<D>::runs_away() const {
  const auto& space = *problem_->space;
  if (!space.finds_deformation) return false;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    const double change = motion_.deformation()[k] - motion_.committed_deformation()[k];
    if (space.found[k] && std::abs(change) > tuned::largest_found_change) return true;
  }
  return false;
}

// Load of a bond, 1 at failure; 0 without a bond [-]. @formula bond
template <int D>
double Increment<D>::bond_load(std::size_t c) const {
  if (!contacts_.bonded(c)) return 0;
  const auto& law = *problem_->law;
  const auto point = contact_point(contacts_, c, motion_.coordinates(), problem_->particles(), law);
  double load = -point.normal_force / law.bond.normal_strength +
                magnitude_of(point.tangential_force) / law.bond.tangential_strength;
  const bool by_moments = law.bond.bending_strength > 0 || law.bond.torsion_strength > 0;
  if (by_moments && law.moments()) {
    load += bond_share(
        contact_moment(contacts_, c, point, motion_.coordinates(), problem_->particles(), law),
        law.bond);
  }
  return load / contacts_.weight_of(c);
}

template <int D>
double Increment<D>::worst_bond() const {
  double worst = 0;
  if (!problem_->law->bonds()) return worst;
  for (std::size_t c = 0; c < contacts_.size(); ++c) worst = std::max(worst, bond_load(c));
  return worst;
}

template <int D>
bool Increment<D>::break_bonds() {
  if (!overloads_bonds()) return false;
  const double energy = potential_energy();
  continue_history();
  losses_.begin_break(energy);
  const double worst = worst_bond();
  const double limit = std::min(worst, 0.5 * (1 + worst));
  std::size_t h = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (!contacts_.bonded(c)) continue;
    while (key_of(history_.contacts()[h]) != key_of(pairs()[c])) ++h;
    if (bond_load(c) < limit) continue;
    history_.break_bond(h);
    losses_.break_bond(contacts_.weight_of(c));
  }
  build_list();
  return true;
}

template <int D>
void Increment<D>::export_to(const Configuration<D>& from, Configuration<D>& to) const {
  motion_.export_to(from, to);
  history_.export_to(to);
  to.dissipated = from.dissipated + losses_.dissipated();
  to.broken_bonds = from.broken_bonds + losses_.broken_bonds();
}

template class Increment<2>;
template class Increment<3>;

}  // namespace grainlaw::core

#include "increment/increment.hpp"

#include "base/constants.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_point.hpp"
#include "increment/contact_state.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace grainlaw::core {

namespace {

std::uint64_t next_epoch() {
  static std::atomic<std::uint64_t> last = 0;
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

}  // namespace

template <int D>
void Increment<D>::begin(const Problem<D>& problem, const Configuration<D>& from,
                         const Tensor<D>& target) {
  epoch_ = next_epoch();
  cost = {};
  Balance::begin(problem, from);
  history_.begin(from);
  deform(target);
}

template <int D>
void Increment<D>::deform(const Tensor<D>& target) {
  released_ = false;
  losses_.end_break();
  motion_.deform(target);
  list_contacts();
}

template <int D>
void Increment<D>::list_contacts() {
  const double gap = tuned::listing_gap * (0.5 * motion_.mean_branch());
  candidates_.list(*problem_, motion_, gap, history_);
  build_list();
}

template <int D>
void Increment<D>::build_list() {
  build_contacts<D>(candidates_.pairs(), candidates_.weights(), problem_->packing->radius,
                    problem_->space->node, problem_->nodes(), *problem_->law, motion_.cell(),
                    history_.from(motion_), contacts_);
}

template <int D>
bool Increment<D>::keep_neighbours() {
  if (!candidates_.outdated(motion_.coordinates())) return false;
  list_contacts();
  return true;
}

template <int D>
void Increment<D>::find_first_drag(bool stressed) {
  motion_.load_records();
  this->sum_masses();
  if (stressed) {
    this->sum_forces(forces_);
    this->reduce(forces_);
  } else {
    std::fill(forces_.begin(), forces_.end(), ForceRecord<D>{});
  }
  motion_.set_first_drag(std::span(forces_).first(problem_->nodes()));
}

template <int D>
void Increment<D>::advance_contacts_and_history() {
  motion_.load_records();
  const auto& law = *problem_->law;
  losses_.dissipate(advance_contacts<D>(motion_.records(), law, contacts_, forces_));
  motion_.restart_rotations();
  if (losses_.after_break()) losses_.fall_to(potential_energy() + dragged());
  history_.clear(pairs(), law);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (bears_load(*this, c))
      history_.add(contacts_, c, pairs()[c], overlap_of(*this, c), scale_.chance(), law);
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
  find_supported(*this, supported_);
  motion_.start_here(supported_);
  build_list();
}

template <int D>
int Increment<D>::released_particle() {
  const auto& space = *problem_->space;
  supported_.assign(problem_->nodes(), 0);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (overlap_of(*this, c) <= 0) continue;
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
bool Increment<D>::runs_away() const {
  const auto& space = *problem_->space;
  if (!space.finds_deformation) return false;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    const double change = motion_.deformation()[k] - motion_.committed_deformation()[k];
    if (space.found[k] && std::abs(change) > tuned::largest_found_change) return true;
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
  const double energy = potential_energy() + dragged();
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

#include "increment/touching_history.hpp"

#include "base/capacity.hpp"
#include "contact/contact_point.hpp"

#include <cmath>

namespace grainlaw::core {

template <int D>
void TouchingHistory<D>::begin(const Configuration<D>& from) {
  copy_with_capacity(from.contacts, contacts_);
  copy_with_capacity(from.moments, moments_);
  copy_with_capacity(from.bond_gaps, gaps_);
}

template <int D>
void TouchingHistory<D>::clear(const std::vector<NeighbourPair<D>>& pairs, const ContactLaw& law) {
  spans_gaps_ = !gaps_.empty();
  contacts_.clear();
  moments_.clear();
  gaps_.clear();
  if (contacts_.capacity() < pairs.size()) contacts_.reserve(pairs.capacity());
  if (law.moments()) moments_.reserve(Dimension<D>::spins * contacts_.capacity());
  if (spans_gaps_) gaps_.reserve(contacts_.capacity());
}

template <int D>
void TouchingHistory<D>::add(const ContactList<D>& contacts, std::size_t c,
                             const NeighbourPair<D>& pair, double depth, double chance,
                             const ContactLaw& law) {
  const double scale = start_scale(depth, law);
  const double weight = contacts.weight_of(c);
  ContactHistory<D>& kept = contacts_.emplace_back();
  kept.i = contacts.i[c];
  kept.j = contacts.j[c];
  kept.shift = pair.shift;
  kept.bonded = contacts.bonded(c);
  if (law.tangential()) {
    std::array<double, Dimension<D>::tangents> force{};
    for (std::size_t k = 0; k < force.size(); ++k) {
      force[k] = contacts.start_force[k][c] * scale;
      kept.tangential_force[k] = force[k] / weight;
    }
    const double bound = law.friction * normal_force(contacts, c, depth, law);
    kept.sliding = !kept.bonded && magnitude_of(force) >= bound - chance;
  }
  if (law.moments()) {
    for (const auto& moment : contacts.start_moment) moments_.push_back(moment[c] * scale / weight);
  }
  if (spans_gaps_) gaps_.push_back(contacts.rest[c] - contacts.reach[c]);
}

template <int D>
void TouchingHistory<D>::export_to(Configuration<D>& to) const {
  copy_with_capacity(contacts_, to.contacts, state_capacity);
  copy_with_capacity(moments_, to.moments, state_capacity);
  copy_with_capacity(gaps_, to.bond_gaps, state_capacity);
}

template class TouchingHistory<2>;
template class TouchingHistory<3>;

}  // namespace grainlaw::core

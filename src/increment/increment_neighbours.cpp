// The contacts of an increment: who may touch, listed anew when that changes.
#include "base/room.hpp"
#include "frame/frame_space.hpp"
#include "increment/increment.hpp"

#include <algorithm>

namespace grainlaw::core {

template <int D>
void Increment<D>::list_neighbours() {
  const auto& packing = *problem->packing;
  listed_.assign(coordinates.begin(),
                 coordinates.begin() + static_cast<std::ptrdiff_t>(dim * particles()));
  search_.find(particles(), coordinates.data(), packing.radius.data(),
               packing.frame ? nullptr : cell.data(), gap_, pairs);
  if (problem->law->bonds()) list_bonded_pairs();
  keep_room(pairs);
  problem->space->drop(pairs);
  pair_weights.clear();
  if constexpr (D == 2) {
    if (packing.frame) weigh_copies(*problem->space, packing, pairs, pair_weights);
  }
  build_list();
}

// Bonds hold however far they are stretched.
template <int D>
void Increment<D>::list_bonded_pairs() {
  merged_pairs_.clear();
  if (merged_pairs_.capacity() < pairs.size() + history.size()) {
    merged_pairs_.reserve(3 * (pairs.size() + history.size()) / 2);
  }
  auto next = pairs.begin();
  for (const auto& contact : history) {
    if (!contact.bonded) continue;
    for (; next != pairs.end() && key_of(*next) < key_of(contact); ++next)
      merged_pairs_.push_back(*next);
    if (next != pairs.end() && key_of(*next) == key_of(contact)) continue;
    merged_pairs_.push_back({contact.i, contact.j, contact.shift});
  }
  merged_pairs_.insert(merged_pairs_.end(), next, pairs.end());
  pairs.swap(merged_pairs_);
}

template <int D>
void Increment<D>::build_list() {
  const HistoryStart<D> from{start, cell_at(start_deformation), history, history_moments,
                             history_gaps};
  build_contacts<D>(pairs, pair_weights, problem->packing->radius, problem->space->node, nodes(),
                    *problem->law, cell, from, contacts);
}

template <int D>
bool Increment<D>::keep_neighbours() {
  const auto n = particles();
  double largest = 0;
  for (std::size_t p = 0; p < n; ++p) {
    Vec<D> moved{};
    for (std::size_t k = 0; k < dim; ++k) moved[k] = coordinates[k * n + p] - listed_[k * n + p];
    largest = std::max(largest, square<D>(moved));
  }
  if (4 * largest <= gap_ * gap_) return false;
  list_neighbours();
  return true;
}

template class Increment<2>;
template class Increment<3>;

}  // namespace grainlaw::core

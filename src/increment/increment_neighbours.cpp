// The contacts of an increment: who may touch, listed anew when that changes.
#include "base/room.hpp"
#include "frame/frame_space.hpp"
#include "increment/increment.hpp"

#include <algorithm>
#include <tuple>

namespace grainlaw {

void Increment::list_neighbours() {
  const auto& packing = *problem->packing;
  listed_.assign(coordinates.begin(),
                 coordinates.begin() + static_cast<std::ptrdiff_t>(2 * particles()));
  search_.find(particles(), coordinates.data(), packing.radius.data(),
               packing.frame ? nullptr : cell.data(), gap_, pairs);
  if (problem->law->bonds()) list_bonded_pairs();
  keep_room(pairs);
  problem->space->drop(pairs);
  pair_weights.clear();
  if (packing.frame) weigh_copies(*problem->space, packing, pairs, pair_weights);
  build_list();
}

// Bonds hold however far they are stretched.
void Increment::list_bonded_pairs() {
  const auto key = [](const auto& pair) { return std::tie(pair.i, pair.j, pair.shift); };
  merged_pairs_.clear();
  if (merged_pairs_.capacity() < pairs.size() + history.size()) {
    merged_pairs_.reserve(3 * (pairs.size() + history.size()) / 2);
  }
  auto next = pairs.begin();
  for (const auto& contact : history) {
    if (!contact.bonded) continue;
    for (; next != pairs.end() && key(*next) < key(contact); ++next) merged_pairs_.push_back(*next);
    if (next != pairs.end() && key(*next) == key(contact)) continue;
    merged_pairs_.push_back({contact.i, contact.j, contact.shift});
  }
  merged_pairs_.insert(merged_pairs_.end(), next, pairs.end());
  pairs.swap(merged_pairs_);
}

void Increment::build_list() {
  const HistoryStart from{start, cell_at(start_deformation), history, history_moments,
                          history_gaps};
  build_contacts(pairs, pair_weights, problem->packing->radius, problem->space->node, nodes(),
                 *problem->law, cell, from, contacts);
}

bool Increment::keep_neighbours() {
  const auto n = particles();
  double largest = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const double dx = coordinates[p] - listed_[p];
    const double dy = coordinates[n + p] - listed_[n + p];
    largest = std::max(largest, dx * dx + dy * dy);
  }
  if (4 * largest <= gap_ * gap_) return false;
  list_neighbours();
  return true;
}

}  // namespace grainlaw

#include "increment/candidates.hpp"

#include "base/capacity.hpp"
#include "frame/frame_space.hpp"

#include <algorithm>

namespace grainlaw::core {

template <int D>
void Candidates<D>::list(const Problem<D>& problem, const Motion<D>& motion, double gap,
                         const TouchingHistory<D>& history) {
  const auto& packing = *problem.packing;
  const auto positions = std::span(motion.coordinates()).first(D * problem.particles());
  listed_.assign(positions.begin(), positions.end());
  gap_ = gap;
  search_.find(problem.particles(), positions.data(), packing.radius.data(),
               packing.frame ? nullptr : motion.cell().data(), gap, pairs_);
  if (problem.law->bonds()) add_bonded(history);
  keep_capacity(pairs_);
  problem.space->drop(pairs_);
  weights_.clear();
  if constexpr (D == 2) {
    if (packing.frame) weigh_copies(*problem.space, packing, pairs_, weights_);
  }
}

template <int D>
void Candidates<D>::add_bonded(const TouchingHistory<D>& history) {
  const auto& contacts = history.contacts();
  merged_.clear();
  if (merged_.capacity() < pairs_.size() + contacts.size()) {
    merged_.reserve(3 * (pairs_.size() + contacts.size()) / 2);
  }
  auto next = pairs_.begin();
  for (const auto& contact : contacts) {
    if (!contact.bonded) continue;
    for (; next != pairs_.end() && key_of(*next) < key_of(contact); ++next) {
      merged_.push_back(*next);
    }
    if (next != pairs_.end() && key_of(*next) == key_of(contact)) continue;
    merged_.push_back({contact.i, contact.j, contact.shift});
  }
  merged_.insert(merged_.end(), next, pairs_.end());
  pairs_.swap(merged_);
}

template <int D>
bool Candidates<D>::outdated(std::span<const double> coordinates) const {
  const std::size_t n = listed_.size() / D;
  double largest = 0;
  for (std::size_t p = 0; p < n; ++p) {
    Vec<D> moved{};
    for (std::size_t k = 0; k < D; ++k) moved[k] = coordinates[k * n + p] - listed_[k * n + p];
    largest = std::max(largest, square<D>(moved));
  }
  return 4 * largest > gap_ * gap_;
}

template class Candidates<2>;
template class Candidates<3>;

}  // namespace grainlaw::core

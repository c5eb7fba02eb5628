#include "contact/half_contact_slots.hpp"

#include "base/capacity.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw::core {

namespace {

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

}  // namespace

// Sorts by counting.
template <std::size_t lanes>
void HalfContactSlots<lanes>::sort(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                                   std::size_t particles, std::span<const std::int32_t> order,
                                   std::span<const char> near) {
  for (auto* count : {&count_, &near_count_}) {
    resize_with_capacity(*count, particles);
    std::fill(count->begin(), count->end(), 0U);
  }
  std::uint32_t most = 31;  // nearly always enough, so that the counts keep their size
  for (std::size_t c = 0; c < i.size(); ++c) {
    const bool counts = near.empty() || near[c] != 0;
    for (const std::int32_t particle : {i[c], j[c]}) {
      ++count_[at(particle)];
      if (counts) most = std::max(most, ++near_count_[at(particle)]);
    }
  }
  resize_with_capacity(first_slot_, most + 2);
  std::fill(first_slot_.begin(), first_slot_.end(), 0U);
  for (const std::uint32_t count : near_count_) ++first_slot_[count + 1];
  std::partial_sum(first_slot_.begin(), first_slot_.end(), first_slot_.begin());
  resize_with_capacity(rows_, (particles + lanes - 1) / lanes);
  std::fill(rows_.begin(), rows_.end(), HalfContactRows{});
  resize_with_capacity(slot_, particles);
  for (std::size_t q = 0; q < particles; ++q) {
    const std::size_t p = order.empty() ? q : at(order[q]);
    slot_[p] = first_slot_[near_count_[p]]++;
    HalfContactRows& rows = rows_[slot_[p] / lanes];
    rows.count = std::max(rows.count, count_[p]);
  }
  std::uint32_t first = 0;
  for (HalfContactRows& rows : rows_) {
    rows.first = first;
    first += rows.count;
  }
  std::fill(count_.begin(), count_.end(), 0U);
}

template class HalfContactSlots<8>;
template class HalfContactSlots<16>;

}  // namespace grainlaw::core

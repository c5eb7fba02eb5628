// Loop that sums stiffnesses of discs, for pseudo-masses.
#pragma once

#include "contact/disc_loops.hpp"

namespace grainlaw::core::disc_loops {

// Writes records (kn, kn, kt d^2 / (R_i + R_j), kr or 1) of the touching contacts.
template <std::size_t width, Features law>
GRAINLAW_INLINE ContactTotals stiffness_loop(const Loop& loop) {
  using V = Lanes<width>;
  ContactList<2>& list = *loop.list;
  const V zero{};
  const V one = zero + 1.0;
  GroupSum<width> force, weight, touching;
  const bool weighted = !list.weight.empty();
  Block at;
  for (std::size_t first = 0; first < list.i.size(); first += block) {
    const std::size_t size = std::min(block, list.i.size() - first);
    find_branches<width>(&loop.particles->x, list, first, size, at);
    for (std::size_t c = 0; c < size; c += width) {
      const V x = load<width>(at.x + c);
      const V y = load<width>(at.y + c);
      const V square = x * x + y * y + tiny;
      const V overlap =
          overlap_of<width, law>(list, first + c, load<width>(at.reach + c), square_root(square));
      const auto here = overlap > least_overlap<width, law>(list, first + c);
      V kn = here ? load<width>(&list.normal_stiffness[first + c]) : zero;
      V kt = here ? load<width>(&list.tangential_stiffness[first + c]) : zero;
      const V touches = here ? one : zero;
      V last = touches;
      if constexpr (law.moments) {
        last = here ? load<width>(&list.bending_stiffness[first + c]) : zero;
      }
      if constexpr (law.hertz) {
        const V root = square_root(largest(overlap, zero));
        kn *= root;
        kt *= root;
        if constexpr (law.moments) last *= root;
        force.add(c, hertz_share * kn * overlap);
      } else if constexpr (law.bonds) {
        force.add(c, kn * magnitude(overlap));
      } else {
        force.add(c, kn * overlap);
      }
      touching.add(c, touches);
      if (weighted) weight.add(c, here ? load<width>(&list.weight[first + c]) : zero);
      put_records<width>({kn, kn, kt * square * load<width>(&list.inverse_reach[first + c]), last},
                         &list.stiffness[first + c].x);
    }
  }
  return {force.total(), weighted ? weight.total() : touching.total(),
          static_cast<int>(touching.total())};
}

}  // namespace grainlaw::core::disc_loops

// A frame of boundary particles around a packing: cutting one out, its geometry, and its copies.
#pragma once

#include "packing/packing.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainlaw::core {

// Cut a periodic packing along two closed chains of near-contacts, from a particle O to its image
// O + L1 and on to O + L2, each copied to the opposite side (Liu, Bosco & Suiker 2017, section 2.1,
// by a shortest-path search instead of the papers' rule, which leaves gaps). Particles 0..n-1 are
// those of the periodic packing in their order, moved by lattice vectors; the copies on the upper
// and right sides follow. Contacts come with every copy that lies in the frame.
//   largest_gap  of two neighbours in a chain, in mean radii [-]
// Throws Error (BAD_PACKING) when there is no chain that closes without leaks: a touching pair of
// which no copy lies in the frame, an image inside it, a chain that crosses itself.
Packing cut_frame(const Packing& periodic, double largest_gap = 0.35);

// Fill partner, area, source, offset and extent of packing.frame from its boundary, corners and
// which of its sides are copies. Throws Error (BAD_PACKING) when these do not make a frame, as it
// is in its reference: anticlockwise from corner 0, a polygon that does not cross itself; and of
// copies, opposite sides shifted by the lattice vectors (to 1e-9 of the frame's length) with equal
// radii.
void complete_frame(Packing& packing);

// Component-major positions in which the frame is undeformed: its reference, or the positions [m].
const std::vector<double>& undeformed(const Packing& packing);

// Where the corners stand in the boundary; the first is 0. Throws Error (BAD_PACKING).
std::array<std::size_t, 4> corner_places(const Frame& frame);

// In one lattice direction: copies of a pair whose particles fill 0..first and 0..second, the
// second `apart` further than the first.
inline int copies_along(int first, int second, int apart) {
  return std::max(0, std::min(first, second - apart) - std::max(0, -apart) + 1);
}

// How many copies of the pair (i, j) the frame holds, itself included, 1 to 4: pairs of the same
// two particles of the periodic packing, equally far apart. Only pairs along a side have more than
// one. Copies between left and right, bottom and top, count when asked for.
inline int contact_copies(const Frame& frame, int i, int j, bool across = true, bool up = true) {
  const auto a = static_cast<std::size_t>(i);
  const auto b = static_cast<std::size_t>(j);
  int copies = 1;
  for (std::size_t k = across ? 0 : 1; k < (up ? 2U : 1U); ++k)
    copies *= copies_along(frame.extent[a][k], frame.extent[b][k],
                           frame.offset[b][k] - frame.offset[a][k]);
  return copies;
}

// Area of the polygon through the centres of the boundary particles, in order, as F carried it from
// the frame's reference [m2].
double polygon_area(const Packing& packing);

}  // namespace grainlaw::core

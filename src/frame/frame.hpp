// A frame of boundary particles around a packing: cut, geometry and copies.
#pragma once

#include "packing/packing.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainlaw::core {

// Cuts a periodic packing along two closed chains of near-contacts, from a particle O to its images
// O + L1 and O + L2. Each chain is copied to the opposite side (Liu, Bosco & Suiker 2017, section
// 2.1). A shortest-path search replaces the paper's rule, which leaves gaps. Particles 0..n-1 are
// those of the periodic packing in order, moved by lattice vectors; copies on the upper and right
// sides follow. Contacts come with every copy that lies in the frame.
//   largest_gap  between neighbours in a chain, in mean radii [-]
// Throws Error (BAD_PACKING) when no chain closes without leaks. Leaks are a touching pair without
// a copy in the frame, an image inside it, and a chain that crosses itself.
Packing cut_frame(const Packing& periodic, double largest_gap = 0.35);

// Sets partner, area, source, offset and extent of packing.frame from its boundary, corners and
// sides that are copies. Throws Error (BAD_PACKING) unless the reference of the frame is a simple
// polygon, anticlockwise from corner 0. Sides that are copies need equal radii and a shift by
// lattice vectors, to 1e-9 of the frame's length.
void complete_frame(Packing& packing);

// Component-major positions in which the frame is undeformed: its reference, or the positions [m].
const std::vector<double>& undeformed(const Packing& packing);

// Places of the corners in the boundary; the first is 0. Throws Error (BAD_PACKING).
std::array<std::size_t, 4> corner_indices(const Frame& frame);

// Copies of a pair in one lattice direction. The particles fill 0..first and 0..second, the second
// `apart` further than the first.
inline int copies_along(int first, int second, int apart) {
  return std::max(0, std::min(first, second - apart) - std::max(0, -apart) + 1);
}

// Number of copies of the pair (i, j) in the frame, itself included, 1 to 4. Copies join the same
// two particles of the periodic packing at one distance; only pairs along a side have more than
// one. `across` counts copies between left and right, `up` between bottom and top.
inline int contact_copies(const Frame& frame, int i, int j, bool across = true, bool up = true) {
  const auto a = static_cast<std::size_t>(i);
  const auto b = static_cast<std::size_t>(j);
  int copies = 1;
  for (std::size_t k = across ? 0 : 1; k < (up ? 2U : 1U); ++k)
    copies *= copies_along(frame.extent[a][k], frame.extent[b][k],
                           frame.offset[b][k] - frame.offset[a][k]);
  return copies;
}

// Area of the polygon through the centres of the boundary particles, carried by F from the frame's
// reference [m2].
double polygon_area(const Packing& packing);

}  // namespace grainlaw::core

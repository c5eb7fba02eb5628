// A boundary condition as a linear space for the fluctuations: particles share the fluctuation of
// their node, x_p = F X_p + w_node(p), and the forces on them add up to the node's residual.
#pragma once

#include "boundary/options.hpp"
#include "packing/neighbours.hpp"
#include "packing/packing.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw {

// periodic-cell: one node per particle, nothing fixed. frame-p (Liu, Bosco & Suiker 2017, eqs.
// 19-20): one node per particle of the periodic packing that was cut, so that opposite edge
// particles share theirs, and the four corners share one whose translation is prescribed.
struct BoundarySpace {
  BoundaryOptions options;
  std::size_t nodes = 0;
  bool identity = true;         // node p is particle p and nothing is fixed
  std::vector<int> node;        // [particles]
  std::vector<char> fixed;      // [nodes] 1: the translation is prescribed
  std::vector<char> boundary;   // [nodes] 1: on the frame
  double reference_volume = 0;  // V at F = I, thickness included [m3]
  double solid_volume = 0;      // of the particles, copies counted once [m3]

  // 1 / (number of copies) of each pair on the frame, or 1 when the option says so.
  void weigh(const Packing& packing, std::span<const NeighbourPair> pairs,
             std::vector<double>& weights) const;
};

// Throws Error (BAD_PACKING) when a frame condition lacks its frame.
BoundarySpace make_boundary_space(const Packing& packing, const BoundaryOptions& options);

}  // namespace grainlaw

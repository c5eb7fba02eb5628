// Neighbour pairs that may touch while particles move less than a gap.
#pragma once

#include "boundary/boundary_space.hpp"
#include "increment/motion.hpp"
#include "increment/touching_history.hpp"
#include "packing/neighbours.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

template <int D>
class Candidates {
 public:
  // Lists all pairs within the gap [m] and all bonded pairs, since bonds transmit force at any
  // stretch.
  void list(const Problem<D>& problem, const Motion<D>& motion, double gap,
            const TouchingHistory<D>& history);
  // True if a particle may have come near one that is not listed.
  [[nodiscard]] bool outdated(std::span<const double> coordinates) const;

  [[nodiscard]] const std::vector<NeighbourPair<D>>& pairs() const { return pairs_; }
  // Weights of the pairs: 1, or 1 / copies [-]. Empty if all are 1.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

 private:
  void add_bonded(const TouchingHistory<D>& history);

  std::vector<NeighbourPair<D>> pairs_, merged_;
  std::vector<double> weights_;
  std::vector<double> listed_;  // positions when the pairs were listed
  double gap_ = 0;
  NeighbourSearch<D> search_;
};

}  // namespace grainlaw::core

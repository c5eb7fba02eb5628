// Which particles are near enough to touch, images of the periodic cell included.
#pragma once

#include "math/tensor.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace grainlaw::core {

// Branch x_j - x_i + H shift.
template <int D>
struct NeighbourPair {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::array<std::int16_t, static_cast<std::size_t>(D)> shift{};
  bool operator==(const NeighbourPair&) const = default;
};

// What pairs and contacts are ordered by.
template <class Pair>
auto key_of(const Pair& pair) {
  return std::tie(pair.i, pair.j, pair.shift);
}

// Neighbour search in O(n): bins in the fractional coordinates of the cell, padded with images, so
// that all candidates of a particle lie in a few contiguous runs. A few particles far larger than the
// rest are kept out of the bins, which they would make as wide as themselves: each looks for the
// others from where it is, and they are a search of their own among themselves.
template <int D>
class NeighbourSearch {
 public:
  // All pairs with |x_j - x_i + H shift| < R_i + R_j + gap, each once, ordered by (i, j, shift)
  // with i <= j; of a particle with its own image only the lexicographically positive shift.
  //   position  component-major, D x n [m], not wrapped into the cell
  //   radius    [n] [m]
  //   cell      H, D x D row-major, lattice vectors as columns [m]; null: no images
  //   gap       >= 0 [m]
  //   pairs     overwritten; nothing is allocated once the vectors have grown
  // The cell may be sheared strongly and smaller than a particle. Throws Error (NOT_CONVERGED) when
  // there is no answer: a position that is not finite, a flat cell, particles more than 2^15 cells
  // (of spheres 2^9) apart.
  void find(std::size_t n, const double* position, const double* radius, const double* cell,
            double gap, std::vector<NeighbourPair<D>>& pairs);

  // Distances that the last search looked at: its work.
  [[nodiscard]] std::size_t candidates() const { return candidates_; }

 private:
  static constexpr std::size_t dim = D;
  using Bin = std::array<std::int32_t, dim>;
  struct Grid;
  Grid make_grid(std::size_t n, const double* position, double binned, double largest,
                 const double* cell, double gap) const;
  void find_homes(const Grid& grid, std::size_t n, const double* position);
  void fill_bins(const Grid& grid, std::size_t n, const double* radius);
  void add_larger(const Grid& grid, std::size_t n, const double* position, const double* radius,
                  const double* cell, double gap, std::vector<NeighbourPair<D>>& pairs);
  template <class Visit>
  void for_runs(const Grid& grid, const Bin& centre, const Bin& reach, Visit&& visit);

  // A particle or an image of one. The key orders by (particle, shift) as one integer.
  struct Entry {
    Vec<D> place;
    double radius;
    std::uint64_t key;
  };
  struct Home {
    Vec<D> place;                           // wrapped into the cell
    Bin bin;                                // in the padded grid
    std::array<std::int64_t, dim> wrapped;  // x = wrapped place + H wrapped
  };
  std::vector<Home> home_;
  std::vector<std::uint32_t> bin_end_;
  std::vector<Entry> entry_;
  std::vector<std::uint64_t> hit_;
  std::size_t candidates_ = 0;
  std::vector<std::int32_t> large_;  // particles that are not in bins
  std::vector<double> large_position_, large_radius_;
  std::vector<NeighbourPair<D>> large_pairs_;
  std::vector<NeighbourSearch> among_large_;  // one, where there are any
};

}  // namespace grainlaw::core

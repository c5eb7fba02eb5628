// Neighbour search with images of the periodic cell.
#pragma once

#include "math/tensor.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace grainlaw::core {

// A pair of particles i, j with branch x_j - x_i + H shift.
template <int D>
struct NeighbourPair {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::array<std::int16_t, static_cast<std::size_t>(D)> shift{};
  bool operator==(const NeighbourPair&) const = default;
};

// Sort key of pairs and contacts.
template <class Pair>
auto key_of(const Pair& pair) {
  return std::tie(pair.i, pair.j, pair.shift);
}

// Neighbour search in O(n) by bins in the fractional coordinates of the cell. Bins are padded with
// images, so that the candidates of a particle lie in a few contiguous runs. Bins are as wide as
// the largest particle in them. Particles far larger than the mean are therefore searched
// separately.
template <int D>
class NeighbourSearch {
 public:
  // Finds all pairs with |x_j - x_i + H shift| < R_i + R_j + gap, each once, ordered by (i, j,
  // shift) with i <= j. A pair of a particle with its own image has the lexicographically positive
  // shift.
  //   position  component-major, D x n [m], not wrapped into the cell
  //   radius    [n] [m]
  //   cell      H, D x D row-major, lattice vectors as columns [m]; null: no images
  //   gap       >= 0 [m]
  //   pairs     overwritten; no allocation once the vectors have grown
  // The cell may be strongly sheared and smaller than a particle. Throws Error (NOT_CONVERGED) for
  // a position that is not finite, for a flat cell, and for particles more than 2^15 cells
  // (spheres: 2^9) apart.
  void find(std::size_t n, const double* position, const double* radius, const double* cell,
            double gap, std::vector<NeighbourPair<D>>& pairs);

  // Number of distances computed by the last search.
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

  // A particle or one of its images. The key orders entries by (particle, shift).
  struct Entry {
    Vec<D> position;
    double radius;
    std::uint64_t key;
  };
  struct Home {
    Vec<D> position;                        // wrapped into the cell
    Bin bin;                                // bin in the padded grid
    std::array<std::int64_t, dim> wrapped;  // x = wrapped place + H wrapped
  };
  std::vector<Home> home_;
  std::vector<std::uint32_t> bin_end_;
  std::vector<Entry> entry_;
  std::vector<std::uint64_t> hit_;
  std::size_t candidates_ = 0;
  std::vector<std::int32_t> large_;  // particles kept out of the bins
  std::vector<double> large_position_, large_radius_;
  std::vector<NeighbourPair<D>> large_pairs_;
  std::vector<NeighbourSearch> among_large_;  // at most one: search among the large particles
};

}  // namespace grainlaw::core

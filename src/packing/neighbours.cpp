#include "packing/neighbours.hpp"

#include "base/capacity.hpp"
#include "base/error.hpp"
#include "packing/neighbour_keys.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace grainlaw::core {

namespace {

using neighbour::for_box;
using neighbour::Key;

// Where the largest radius exceeds much_larger means, particles beyond `larger` means are kept out
// of the bins [-]. These are fewer than half of all.
constexpr double much_larger = 4;
constexpr double larger = 2;

[[noreturn]] void no_answer(const char* why) {
  throw Error(GRAINLAW_NOT_CONVERGED, std::string("neighbour search: ") + why);
}

// Distances between opposite sides of a cell [m].
template <int D>
Vec<D> widths(const Tensor<D>& cell, const Tensor<D>& inverse, double volume) {
  if constexpr (D == 2) {
    return {std::abs(volume) / std::hypot(cell[1], cell[3]),
            std::abs(volume) / std::hypot(cell[0], cell[2])};
  } else {
    Vec<D> result{};
    for (std::size_t k = 0; k < D; ++k) {
      result[k] = 1 / std::hypot(inverse[D * k], inverse[D * k + 1], inverse[D * k + 2]);
    }
    return result;
  }
}

}  // namespace

template <int D>
struct NeighbourSearch<D>::Grid {
  Tensor<D> cell{};  // lattice vectors as columns
  Tensor<D> inverse{};
  Vec<D> origin{};
  Bin count{};        // bins in the cell itself
  Bin reach{};        // bins to each side that may contain a neighbour of a binned particle
  Bin margin{};       // bins to each side that may contain a neighbour of any particle
  double binned = 0;  // largest radius among binned particles [m]
  bool images = false;

  [[nodiscard]] std::int32_t padded(std::size_t k) const { return count[k] + 2 * margin[k]; }
  [[nodiscard]] std::size_t bin(const Bin& at) const {
    auto index = static_cast<std::size_t>(at[dim - 1]);
    for (std::size_t k = dim - 1; k-- > 0;) {
      index = index * static_cast<std::size_t>(padded(k)) + static_cast<std::size_t>(at[k]);
    }
    return index;
  }
  [[nodiscard]] std::size_t bins() const {
    std::size_t product = 1;
    for (std::size_t k = 0; k < dim; ++k) product *= static_cast<std::size_t>(padded(k));
    return product;
  }
  // x + sign H counts.
  template <class Counts>
  [[nodiscard]] Vec<D> shifted(Vec<D> x, double sign, const Counts& counts) const {
    for (std::size_t k = 0; k < dim; ++k) {
      for (std::size_t l = 0; l < dim; ++l) {
        x[k] += sign * cell[dim * k + l] * static_cast<double>(counts[l]);
      }
    }
    return x;
  }
};

template <int D>
auto NeighbourSearch<D>::make_grid(std::size_t n, const double* position, double binned,
                                   double largest, const double* cell, double gap) const -> Grid {
  constexpr double surplus = 1 + 1e-9;  // margin for the rounding of fractional coordinates
  Grid grid;
  grid.images = cell != nullptr;
  if (cell != nullptr) {
    grid.cell = tensor_of<D>(cell);
  } else {
    const double around = (2 * largest + gap) * surplus;
    for (std::size_t k = 0; k < dim; ++k) {
      const auto [least, most] = std::minmax_element(position + k * n, position + (k + 1) * n);
      grid.origin[k] = *least;
      grid.cell[(dim + 1) * k] = *most - *least + around;
    }
  }
  const double volume = determinant<D>(grid.cell);
  if (!(std::abs(volume) > 0) || !std::isfinite(volume))
    no_answer("the cell is flat or not finite");
  grid.inverse = inverse<D>(grid.cell);

  // More bins than particles gain nothing.
  const auto number = static_cast<double>(n);
  const double most = std::ceil(2 * (D == 2 ? std::sqrt(number) : std::cbrt(number)));
  const Vec<D> width = widths<D>(grid.cell, grid.inverse, volume);
  // A cell hardly wider than the largest particle would need far more padding bins than its own.
  const double widest_range = (largest + binned + gap) * surplus;
  const bool narrow = widest_range > 2 * *std::min_element(width.begin(), width.end());
  grid.binned = narrow ? largest : binned;
  const double range = (2 * grid.binned + gap) * surplus;
  for (std::size_t k = 0; k < dim; ++k) {
    const double bins = std::clamp(std::floor(width[k] / range), 1.0, most);
    const double reach = std::ceil(range * bins / width[k]);
    if (!(reach <= 64)) no_answer("the cell is far thinner than a particle");
    grid.count[k] = static_cast<std::int32_t>(bins);
    grid.reach[k] = std::max(1, static_cast<std::int32_t>(reach));
    const double margin = narrow ? 0 : std::ceil(widest_range * bins / width[k]);
    grid.margin[k] = std::max(grid.reach[k], static_cast<std::int32_t>(margin));
  }
  return grid;
}

template <int D>
void NeighbourSearch<D>::find_homes(const Grid& grid, std::size_t n, const double* position) {
  home_.resize(n);
  Vec<D> lowest, highest;
  lowest.fill(1e300);
  highest.fill(-1e300);
  for (std::size_t p = 0; p < n; ++p) {
    Vec<D> x{}, cells{};
    for (std::size_t k = 0; k < dim; ++k) x[k] = position[k * n + p] - grid.origin[k];
    for (std::size_t k = 0; k < dim; ++k) {
      const double s = dot<D>(grid.inverse.data() + dim * k, x.data());
      if (!(std::abs(s) < 1e15)) no_answer("a position is not finite");
      cells[k] = grid.images ? std::floor(s) : 0.0;
      lowest[k] = std::min(lowest[k], cells[k]);
      highest[k] = std::max(highest[k], cells[k]);
      const auto bin = static_cast<std::int32_t>((s - cells[k]) * grid.count[k]);
      home_[p].bin[k] = std::clamp(bin, 0, grid.count[k] - 1) + grid.margin[k];
      home_[p].wrapped[k] = static_cast<std::int64_t>(cells[k]);
    }
    home_[p].position = grid.shifted(x, -1, cells);
  }
  for (std::size_t k = 0; k < dim; ++k) {
    if (highest[k] - lowest[k] + grid.margin[k] + 1 > static_cast<double>(Key<D>::largest_shift))
      no_answer(D == 2 ? "particles are more than 2^15 cells apart"
                       : "particles are more than 2^9 cells apart");
    for (Home& home : home_) home.wrapped[k] -= static_cast<std::int64_t>(lowest[k]);
  }
}

template <int D>
void NeighbourSearch<D>::fill_bins(const Grid& grid, std::size_t n, const double* radius) {
  // Visits every image whose bin lies in the padded grid; used twice, to count and to fill.
  const auto for_images = [&](auto&& visit) {
    for (std::size_t p = 0; p < n; ++p) {
      if (!(radius[p] <= grid.binned)) continue;
      const Bin bin = home_[p].bin;
      Bin first{}, last{};
      for (std::size_t k = 0; k < dim && grid.images; ++k) {
        while (bin[k] + (first[k] - 1) * grid.count[k] >= 0) --first[k];
        while (bin[k] + (last[k] + 1) * grid.count[k] < grid.padded(k)) ++last[k];
      }
      for_box(first, last, [&](const Bin& q) {
        Bin at = bin;
        for (std::size_t k = 0; k < dim; ++k) at[k] += q[k] * grid.count[k];
        visit(p, q, grid.bin(at));
      });
    }
  };
  const std::size_t bins = grid.bins();
  // bin_end_[b + 1] is the start of bin b while entries are filled in, and its end afterwards.
  resize_with_capacity(bin_end_, bins + 2);
  std::fill(bin_end_.begin(), bin_end_.end(), 0);
  for_images([&](std::size_t, const Bin&, std::size_t b) { ++bin_end_[b + 2]; });
  for (std::size_t b = 0; b < bins; ++b) bin_end_[b + 2] += bin_end_[b + 1];
  resize_with_capacity(entry_, bin_end_[bins + 1]);
  for_images([&](std::size_t p, const Bin& q, std::size_t b) {
    const Home& home = home_[p];
    std::array<std::int64_t, dim> shift;
    for (std::size_t k = 0; k < dim; ++k) shift[k] = q[k] - home.wrapped[k];
    entry_[bin_end_[b + 1]++] = {grid.shifted(home.position, 1, q), radius[p],
                                 Key<D>::of_particle(p) + Key<D>::of_shift(shift)};
  });
}

// Calls visit(entry) for all entries in the bins around a bin, by runs along the first direction.
template <int D>
template <class Visit>
void NeighbourSearch<D>::for_runs(const Grid& grid, const Bin& centre, const Bin& reach,
                                  Visit&& visit) {
  Bin first{}, last{};
  for (std::size_t k = 1; k < dim; ++k) {
    first[k] = centre[k] - reach[k];
    last[k] = centre[k] + reach[k];
  }
  for_box(first, last, [&](Bin at) {
    at[0] = centre[0] - reach[0];
    const std::uint32_t begin = bin_end_[grid.bin(at)];
    at[0] = centre[0] + reach[0];
    const std::uint32_t end = bin_end_[grid.bin(at) + 1];
    candidates_ += end - begin;
    for (std::uint32_t e = begin; e < end; ++e) visit(entry_[e]);
  });
}

template <int D>
void NeighbourSearch<D>::find(std::size_t n, const double* position, const double* radius,
                              const double* cell, double gap,
                              std::vector<NeighbourPair<D>>& pairs) {
  pairs.clear();
  candidates_ = 0;
  if (n == 0) return;
  const double largest = *std::max_element(radius, radius + n);
  const double mean = std::accumulate(radius, radius + n, 0.0) / static_cast<double>(n);
  const double binned = largest > much_larger * mean ? larger * mean : largest;
  const Grid grid = make_grid(n, position, binned, largest, cell, gap);
  find_homes(grid, n, position);
  fill_bins(grid, n, radius);
  resize_with_capacity(hit_, entry_.size() + 1);

  for (std::size_t i = 0; i < n; ++i) {
    if (!(radius[i] <= grid.binned)) continue;
    const Home& home = home_[i];
    const double reach = radius[i] + gap;
    const std::uint64_t origin = Key<D>::of_shift(home.wrapped);
    // Only later particles, and later images of the same particle, are visited: each pair comes
    // once.
    const std::uint64_t self = Key<D>::of_particle(i);
    std::size_t hits = 0;
    for_runs(grid, home.bin, grid.reach, [&](const Entry& other) {
      Vec<D> apart{};
      for (std::size_t k = 0; k < dim; ++k) apart[k] = other.position[k] - home.position[k];
      const double limit = reach + other.radius;
      const std::uint64_t key = other.key + origin;
      hit_[hits] = key;
      hits += static_cast<std::size_t>((square<D>(apart) < limit * limit) & (key > self));
    });
    // Insertion sort, since a particle has few neighbours.
    for (std::size_t a = 1; a < hits; ++a) {
      const std::uint64_t key = hit_[a];
      std::size_t b = a;
      for (; b > 0 && hit_[b - 1] > key; --b) hit_[b] = hit_[b - 1];
      hit_[b] = key;
    }
    for (std::size_t a = 0; a < hits; ++a) pairs.push_back(Key<D>::pair(i, hit_[a]));
  }
  if (grid.binned < largest) add_larger(grid, n, position, radius, cell, gap, pairs);
}

// Adds pairs with at least one particle outside the bins.
template <int D>
void NeighbourSearch<D>::add_larger(const Grid& grid, std::size_t n, const double* position,
                                    const double* radius, const double* cell, double gap,
                                    std::vector<NeighbourPair<D>>& pairs) {
  const std::size_t in_bins = pairs.size();
  large_.clear();
  for (std::size_t i = 0; i < n; ++i)
    if (!(radius[i] <= grid.binned)) large_.push_back(static_cast<std::int32_t>(i));
  for (const std::int32_t i : large_) {
    const auto p = static_cast<std::size_t>(i);
    const Home& home = home_[p];
    const std::uint64_t origin = Key<D>::of_shift(home.wrapped);
    for_runs(grid, home.bin, grid.margin, [&](const Entry& other) {
      Vec<D> apart{};
      for (std::size_t k = 0; k < dim; ++k) apart[k] = other.position[k] - home.position[k];
      const double limit = radius[p] + gap + other.radius;
      if (!(square<D>(apart) < limit * limit)) return;
      NeighbourPair<D> pair = Key<D>::pair(p, other.key + origin);
      if (pair.i > pair.j) {
        std::swap(pair.i, pair.j);
        for (std::int16_t& shift : pair.shift) shift = static_cast<std::int16_t>(-shift);
      }
      pairs.push_back(pair);
    });
  }
  large_radius_.clear();
  large_position_.clear();
  for (const std::int32_t i : large_) large_radius_.push_back(radius[i]);
  for (std::size_t k = 0; k < dim; ++k)
    for (const std::int32_t i : large_)
      large_position_.push_back(position[k * n + static_cast<std::size_t>(i)]);
  if (among_large_.empty()) among_large_.resize(1);
  among_large_.front().find(large_.size(), large_position_.data(), large_radius_.data(), cell, gap,
                            large_pairs_);
  candidates_ += among_large_.front().candidates();
  for (const NeighbourPair<D>& pair : large_pairs_)
    pairs.push_back({large_[static_cast<std::size_t>(pair.i)],
                     large_[static_cast<std::size_t>(pair.j)], pair.shift});
  // Pairs of binned particles are already in order.
  const auto before = [](const auto& a, const auto& b) { return key_of(a) < key_of(b); };
  const auto middle = pairs.begin() + static_cast<std::ptrdiff_t>(in_bins);
  std::sort(middle, pairs.end(), before);
  std::inplace_merge(pairs.begin(), middle, pairs.end(), before);
}

template class NeighbourSearch<2>;
template class NeighbourSearch<3>;

}  // namespace grainlaw::core

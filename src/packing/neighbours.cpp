#include "packing/neighbours.hpp"

#include "base/error.hpp"
#include "base/room.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace grainlaw {

namespace {

// Key of (particle, shift): particle in the upper half, then the two shifts plus a bias, so that
// comparing keys compares (particle, shift) and adding a shift is one addition.
constexpr std::int64_t shift_bias = 32768;
constexpr std::int64_t largest_shift = 32767;

// Where the largest disc is so much larger than the mean, those beyond `larger` of it are not put in
// bins: fewer than half, and usually a few [-].
constexpr double much_larger = 4;
constexpr double larger = 2;

std::uint64_t shift_key(std::int64_t s0, std::int64_t s1) {
  return (static_cast<std::uint64_t>(s0) << 16) + static_cast<std::uint64_t>(s1);
}

std::uint64_t particle_key(std::size_t particle) {
  return (static_cast<std::uint64_t>(particle) << 32) + shift_key(shift_bias, shift_bias);
}

NeighbourPair pair_of(std::size_t i, std::uint64_t key) {
  const auto component = [](std::uint64_t bits) {
    return static_cast<std::int16_t>(static_cast<std::int64_t>(bits & 0xffff) - shift_bias);
  };
  return {static_cast<std::int32_t>(i),
          static_cast<std::int32_t>(key >> 32),
          {component(key >> 16), component(key)}};
}

[[noreturn]] void no_answer(const char* why) {
  throw Error(GRAINLAW_NOT_CONVERGED, std::string("neighbour search: ") + why);
}

}  // namespace

struct NeighbourSearch::Grid {
  std::array<double, 4> cell{};  // lattice vectors as columns
  std::array<double, 4> inverse{};
  std::array<double, 2> origin{};
  std::array<std::int32_t, 2> count{1, 1};   // bins of the cell itself
  std::array<std::int32_t, 2> reach{1, 1};   // bins to each side that can hold a neighbour of those
  std::array<std::int32_t, 2> margin{1, 1};  // in bins, and of any
  double binned = 0;                         // largest radius in bins [m]
  bool images = false;

  [[nodiscard]] std::int32_t padded(std::size_t k) const { return count[k] + 2 * margin[k]; }
  [[nodiscard]] std::size_t bin(std::int32_t b0, std::int32_t b1) const {
    return static_cast<std::size_t>(b1) * static_cast<std::size_t>(padded(0)) +
           static_cast<std::size_t>(b0);
  }
};

NeighbourSearch::Grid NeighbourSearch::make_grid(std::size_t n, const double* position,
                                                 double binned, double largest, const double* cell,
                                                 double gap) const {
  const double* x = position;
  const double* y = position + n;
  constexpr double surplus = 1 + 1e-9;  // covers the rounding of fractional coordinates
  Grid grid;
  grid.images = cell != nullptr;
  if (cell != nullptr) {
    std::copy(cell, cell + 4, grid.cell.begin());
  } else {
    const auto [x_min, x_max] = std::minmax_element(x, x + n);
    const auto [y_min, y_max] = std::minmax_element(y, y + n);
    grid.origin = {*x_min, *y_min};
    const double around = (2 * largest + gap) * surplus;
    grid.cell = {*x_max - *x_min + around, 0, 0, *y_max - *y_min + around};
  }
  const auto& h = grid.cell;
  const double area = h[0] * h[3] - h[1] * h[2];
  if (!(std::abs(area) > 0) || !std::isfinite(area)) no_answer("the cell is flat or not finite");
  grid.inverse = {h[3] / area, -h[1] / area, -h[2] / area, h[0] / area};

  // More bins than particles help nobody.
  const double most = std::ceil(2 * std::sqrt(static_cast<double>(n)));
  const std::array<double, 2> width = {std::abs(area) / std::hypot(h[1], h[3]),
                                       std::abs(area) / std::hypot(h[0], h[2])};
  // Around a cell that is hardly wider than the largest disc there would be far more bins than in it.
  const double widest_range = (largest + binned + gap) * surplus;
  const bool narrow = widest_range > 2 * std::min(width[0], width[1]);
  grid.binned = narrow ? largest : binned;
  const double range = (2 * grid.binned + gap) * surplus;
  for (std::size_t k = 0; k < 2; ++k) {
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

void NeighbourSearch::fill_bins(const Grid& grid, std::size_t n, const double* position,
                                const double* radius) {
  home_.resize(n);
  std::array<double, 2> lowest = {1e300, 1e300};
  std::array<double, 2> highest = {-1e300, -1e300};
  for (std::size_t p = 0; p < n; ++p) {
    const double dx = position[p] - grid.origin[0];
    const double dy = position[n + p] - grid.origin[1];
    std::array<double, 2> cells{};
    for (std::size_t k = 0; k < 2; ++k) {
      const double s = grid.inverse[2 * k] * dx + grid.inverse[2 * k + 1] * dy;
      if (!(std::abs(s) < 1e15)) no_answer("a position is not finite");
      cells[k] = grid.images ? std::floor(s) : 0.0;
      lowest[k] = std::min(lowest[k], cells[k]);
      highest[k] = std::max(highest[k], cells[k]);
      const auto bin = static_cast<std::int32_t>((s - cells[k]) * grid.count[k]);
      home_[p].bin[k] = std::clamp(bin, 0, grid.count[k] - 1) + grid.margin[k];
      home_[p].wrapped[k] = static_cast<std::int64_t>(cells[k]);
    }
    home_[p].x = dx - grid.cell[0] * cells[0] - grid.cell[1] * cells[1];
    home_[p].y = dy - grid.cell[2] * cells[0] - grid.cell[3] * cells[1];
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (highest[k] - lowest[k] + grid.margin[k] + 1 > static_cast<double>(largest_shift))
      no_answer("particles are more than 2^15 cells apart");
    for (Home& home : home_) home.wrapped[k] -= static_cast<std::int64_t>(lowest[k]);
  }

  // Every image whose bin lies in the padded grid; twice, to count and to place.
  const auto for_images = [&](auto&& visit) {
    for (std::size_t p = 0; p < n; ++p) {
      if (!(radius[p] <= grid.binned)) continue;
      const std::array<std::int32_t, 2> bin = home_[p].bin;
      std::array<std::int32_t, 2> first{};
      std::array<std::int32_t, 2> last{};
      for (std::size_t k = 0; k < 2 && grid.images; ++k) {
        while (bin[k] + (first[k] - 1) * grid.count[k] >= 0) --first[k];
        while (bin[k] + (last[k] + 1) * grid.count[k] < grid.padded(k)) ++last[k];
      }
      for (std::int32_t q1 = first[1]; q1 <= last[1]; ++q1)
        for (std::int32_t q0 = first[0]; q0 <= last[0]; ++q0)
          visit(p, q0, q1, grid.bin(bin[0] + q0 * grid.count[0], bin[1] + q1 * grid.count[1]));
    }
  };
  const auto bins =
      static_cast<std::size_t>(grid.padded(0)) * static_cast<std::size_t>(grid.padded(1));
  // bin_end_[b + 1] is first the start of bin b, and its end when all entries are placed.
  resize_with_room(bin_end_, bins + 2);
  std::fill(bin_end_.begin(), bin_end_.end(), 0);
  for_images([&](std::size_t, std::int32_t, std::int32_t, std::size_t b) { ++bin_end_[b + 2]; });
  for (std::size_t b = 0; b < bins; ++b) bin_end_[b + 2] += bin_end_[b + 1];
  resize_with_room(entry_, bin_end_[bins + 1]);
  for_images([&](std::size_t p, std::int32_t q0, std::int32_t q1, std::size_t b) {
    const Home& home = home_[p];
    const auto a0 = static_cast<double>(q0);
    const auto a1 = static_cast<double>(q1);
    entry_[bin_end_[b + 1]++] = {
        home.x + grid.cell[0] * a0 + grid.cell[1] * a1,
        home.y + grid.cell[2] * a0 + grid.cell[3] * a1, radius[p],
        particle_key(p) + shift_key(q0 - home.wrapped[0], q1 - home.wrapped[1])};
  });
}

void NeighbourSearch::find(std::size_t n, const double* position, const double* radius,
                           const double* cell, double gap, std::vector<NeighbourPair>& pairs) {
  pairs.clear();
  if (n == 0) return;
  const double largest = *std::max_element(radius, radius + n);
  const double mean = std::accumulate(radius, radius + n, 0.0) / static_cast<double>(n);
  const double binned = largest > much_larger * mean ? larger * mean : largest;
  const Grid grid = make_grid(n, position, binned, largest, cell, gap);
  fill_bins(grid, n, position, radius);
  resize_with_room(hit_, entry_.size() + 1);

  for (std::size_t i = 0; i < n; ++i) {
    if (!(radius[i] <= grid.binned)) continue;
    const Home& home = home_[i];
    const double reach = radius[i] + gap;
    const std::uint64_t origin = shift_key(home.wrapped[0], home.wrapped[1]);
    // Pairs come once: later particles, and later images of the same one.
    const std::uint64_t self = particle_key(i);
    std::size_t hits = 0;
    for (std::int32_t b1 = home.bin[1] - grid.reach[1]; b1 <= home.bin[1] + grid.reach[1]; ++b1) {
      const std::uint32_t first = bin_end_[grid.bin(home.bin[0] - grid.reach[0], b1)];
      const std::uint32_t last = bin_end_[grid.bin(home.bin[0] + grid.reach[0], b1) + 1];
      for (std::uint32_t e = first; e < last; ++e) {
        const Entry& other = entry_[e];
        const double dx = other.x - home.x;
        const double dy = other.y - home.y;
        const double limit = reach + other.radius;
        const std::uint64_t key = other.key + origin;
        hit_[hits] = key;
        hits += static_cast<std::size_t>((dx * dx + dy * dy < limit * limit) & (key > self));
      }
    }
    // A handful of keys: insertion sort.
    for (std::size_t a = 1; a < hits; ++a) {
      const std::uint64_t key = hit_[a];
      std::size_t b = a;
      for (; b > 0 && hit_[b - 1] > key; --b) hit_[b] = hit_[b - 1];
      hit_[b] = key;
    }
    for (std::size_t a = 0; a < hits; ++a) pairs.push_back(pair_of(i, hit_[a]));
  }
  if (grid.binned < largest) add_larger(grid, n, position, radius, cell, gap, pairs);
}

// Pairs with at least one disc that is not in bins.
void NeighbourSearch::add_larger(const Grid& grid, std::size_t n, const double* position,
                                 const double* radius, const double* cell, double gap,
                                 std::vector<NeighbourPair>& pairs) {
  const std::size_t in_bins = pairs.size();
  large_.clear();
  for (std::size_t i = 0; i < n; ++i)
    if (!(radius[i] <= grid.binned)) large_.push_back(static_cast<std::int32_t>(i));
  for (const std::int32_t i : large_) {
    const auto p = static_cast<std::size_t>(i);
    const Home& home = home_[p];
    const std::uint64_t origin = shift_key(home.wrapped[0], home.wrapped[1]);
    for (std::int32_t b1 = home.bin[1] - grid.margin[1]; b1 <= home.bin[1] + grid.margin[1]; ++b1) {
      const std::uint32_t first = bin_end_[grid.bin(home.bin[0] - grid.margin[0], b1)];
      const std::uint32_t last = bin_end_[grid.bin(home.bin[0] + grid.margin[0], b1) + 1];
      for (std::uint32_t e = first; e < last; ++e) {
        const double dx = entry_[e].x - home.x;
        const double dy = entry_[e].y - home.y;
        const double limit = radius[p] + gap + entry_[e].radius;
        if (!(dx * dx + dy * dy < limit * limit)) continue;
        NeighbourPair pair = pair_of(p, entry_[e].key + origin);
        if (pair.i > pair.j) {
          std::swap(pair.i, pair.j);
          for (std::int16_t& shift : pair.shift) shift = static_cast<std::int16_t>(-shift);
        }
        pairs.push_back(pair);
      }
    }
  }
  large_radius_.clear();
  large_position_.clear();
  for (const std::int32_t i : large_) large_radius_.push_back(radius[i]);
  for (std::size_t k = 0; k < 2; ++k)
    for (const std::int32_t i : large_)
      large_position_.push_back(position[k * n + static_cast<std::size_t>(i)]);
  if (among_large_.empty()) among_large_.resize(1);
  among_large_.front().find(large_.size(), large_position_.data(), large_radius_.data(), cell, gap,
                            large_pairs_);
  for (const NeighbourPair& pair : large_pairs_)
    pairs.push_back({large_[static_cast<std::size_t>(pair.i)],
                     large_[static_cast<std::size_t>(pair.j)], pair.shift});
  // Those of the rest are in order.
  const auto before = [](const NeighbourPair& a, const NeighbourPair& b) {
    return std::tie(a.i, a.j, a.shift) < std::tie(b.i, b.j, b.shift);
  };
  const auto middle = pairs.begin() + static_cast<std::ptrdiff_t>(in_bins);
  std::sort(middle, pairs.end(), before);
  std::inplace_merge(pairs.begin(), middle, pairs.end(), before);
}

}  // namespace grainlaw

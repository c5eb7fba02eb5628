#include "generate/generator.hpp"

#include "base/error.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace grainlaw::core {

namespace {

// Dense enough for a short compaction, loose enough that the first trials for a place succeed
// (random sequential adsorption of discs jams at 0.547).
constexpr double volume_fraction = 0.4;
constexpr int most_trials = 100000;

void shuffle(std::vector<double>& values, std::mt19937_64& engine) {
  for (std::size_t k = values.size(); k > 1; --k) {
    const auto other = static_cast<std::size_t>(unit_double(engine) * static_cast<double>(k));
    std::swap(values[k - 1], values[other]);
  }
}

void check(const GeneratorOptions& options) {
  const auto require = [](bool right, const char* name, double value, const char* expected) {
    if (!right)
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("generator: {} = {}, expected {}", name, value, expected));
  };
  require(options.count >= 1 && options.count <= 10'000'000, "count",
          static_cast<double>(options.count), "1 to 10^7 particles");
  require(options.radius_min > 0 && std::isfinite(options.radius_min), "radius_min",
          options.radius_min, "a length > 0");
  require(options.radius_max >= options.radius_min && std::isfinite(options.radius_max),
          "radius_max", options.radius_max, "a length >= radius_min");
  require(options.thickness > 0 && std::isfinite(options.thickness), "thickness", options.thickness,
          "a length > 0");
  require(options.density > 0 && std::isfinite(options.density), "density", options.density,
          "a density > 0");
}

// Discs already placed, in bins at least two largest radii wide, over a periodic square.
class PlacedDiscs {
 public:
  PlacedDiscs(double side, double radius_max)
      : side_(side), bins_(std::max(1, static_cast<int>(side / (2 * radius_max)))) {
    members_.resize(static_cast<std::size_t>(bins_) * static_cast<std::size_t>(bins_));
  }

  [[nodiscard]] bool fits(double x, double y, double radius) const {
    for (int b = bin(y) - 1; b <= bin(y) + 1; ++b)
      for (int a = bin(x) - 1; a <= bin(x) + 1; ++a)
        for (const Disc& disc : members_[index(a, b)]) {
          const double limit = radius + disc.radius;
          const double dx = std::remainder(x - disc.x, side_);
          const double dy = std::remainder(y - disc.y, side_);
          if (dx * dx + dy * dy < limit * limit) return false;
        }
    return true;
  }

  void add(double x, double y, double radius) {
    members_[index(bin(x), bin(y))].push_back({x, y, radius});
  }

 private:
  struct Disc {
    double x, y, radius;
  };
  [[nodiscard]] int bin(double x) const {
    return std::min(static_cast<int>(x / side_ * bins_), bins_ - 1);
  }
  [[nodiscard]] std::size_t index(int a, int b) const {
    return static_cast<std::size_t>((a + bins_) % bins_ + bins_ * ((b + bins_) % bins_));
  }

  double side_;
  int bins_;
  std::vector<std::vector<Disc>> members_;
};

}  // namespace

std::vector<double> graded_radii(const GeneratorOptions& options, std::mt19937_64& engine) {
  const auto n = static_cast<double>(options.count);
  std::vector<double> radii;
  for (std::size_t p = 0; p < options.count; ++p)
    radii.push_back(options.radius_min +
                    (options.radius_max - options.radius_min) * (static_cast<double>(p) + 0.5) / n);
  shuffle(radii, engine);
  return radii;
}

Packing scatter(const GeneratorOptions& options) {
  check(options);
  const std::size_t n = options.count;
  std::mt19937_64 engine(options.seed);
  Packing packing;
  packing.thickness = options.thickness;
  packing.density = options.density;
  packing.radius = graded_radii(options, engine);

  double solid = 0;
  for (const double r : packing.radius) solid += particle_size<2>(r);
  const double side = std::sqrt(solid / volume_fraction);
  packing.cell = {side, 0, 0, side};
  packing.position.resize(2 * n);

  // Large discs first: they are the ones that may not find a place.
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return packing.radius[a] > packing.radius[b];
  });
  PlacedDiscs placed(side, options.radius_max);
  for (const std::size_t p : order) {
    int trials = 0;
    double x = 0;
    double y = 0;
    do {
      if (++trials > most_trials)
        throw Error(GRAINLAW_BAD_PACKING,
                    "generator: no room for a disc; the radii differ too much");
      x = side * unit_double(engine);
      y = side * unit_double(engine);
    } while (!placed.fits(x, y, packing.radius[p]));
    placed.add(x, y, packing.radius[p]);
    packing.position[p] = x;
    packing.position[n + p] = y;
  }
  return packing;
}

}  // namespace grainlaw::core

#include "generate/generator.hpp"

#include "base/error.hpp"
#include "generate/generator_checks.hpp"
#include "packing/geometry.hpp"
#include "packing/neighbour_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace grainlaw::core {

namespace {

// Volume fraction of scattered particles: dense enough for a short compaction, loose enough that
// first trials succeed. Random sequential adsorption jams at 0.547 for discs and at 0.38 for
// spheres.
template <int D>
constexpr double volume_fraction = D == 2 ? 0.4 : 0.25;
constexpr int most_trials = 100000;

void shuffle(std::vector<double>& values, std::mt19937_64& engine) {
  for (std::size_t k = values.size(); k > 1; --k) {
    const auto other = static_cast<std::size_t>(unit_double(engine) * static_cast<double>(k));
    std::swap(values[k - 1], values[other]);
  }
}

void check(const GeneratorOptions& options) {
  const auto require = [](bool right, const char* name, double value, const char* expected) {
    if (!right) wrong(name, value, expected);
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

// Particles already placed, in bins at least two largest radii wide, over a periodic square or
// cube.
template <int D>
class Placed {
 public:
  Placed(double side, double radius_max)
      : side_(side), bins_(std::max(1, static_cast<int>(side / (2 * radius_max)))) {
    std::size_t all = 1;
    for (int k = 0; k < D; ++k) all *= static_cast<std::size_t>(bins_);
    members_.resize(all);
  }

  [[nodiscard]] bool fits(const Vec<D>& position, double radius) const {
    Bin first = bin(position);
    Bin last = first;
    for (std::size_t k = 0; k < D; ++k) {
      --first[k];
      ++last[k];
    }
    bool fits = true;
    neighbour::for_box(first, last, [&](const Bin& at) {
      for (const Particle& other : members_[index(at)]) {
        const double limit = radius + other.radius;
        Vec<D> apart;
        for (std::size_t k = 0; k < D; ++k) {
          apart[k] = std::remainder(position[k] - other.position[k], side_);
        }
        if (square<D>(apart) < limit * limit) fits = false;
      }
    });
    return fits;
  }

  void add(const Vec<D>& position, double radius) {
    members_[index(bin(position))].push_back({position, radius});
  }

 private:
  struct Particle {
    Vec<D> position;
    double radius;
  };
  using Bin = std::array<std::int32_t, static_cast<std::size_t>(D)>;

  [[nodiscard]] Bin bin(const Vec<D>& position) const {
    Bin result;
    for (std::size_t k = 0; k < D; ++k) {
      result[k] = std::min(static_cast<int>(position[k] / side_ * bins_), bins_ - 1);
    }
    return result;
  }
  [[nodiscard]] std::size_t index(const Bin& bin) const {
    std::size_t index = 0;
    for (std::size_t k = D; k-- > 0;) {
      index = static_cast<std::size_t>(bins_) * index +
              static_cast<std::size_t>((bin[k] + bins_) % bins_);
    }
    return index;
  }

  double side_;
  int bins_;
  std::vector<std::vector<Particle>> members_;
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

template <int D>
Packing scatter(const GeneratorOptions& options) {
  check(options);
  const std::size_t n = options.count;
  std::mt19937_64 engine(options.seed);
  Packing packing;
  packing.dimension = D;
  if (D == 2) packing.thickness = options.thickness;
  packing.density = options.density;
  packing.radius = graded_radii(options, engine);

  double solid = 0;
  for (const double r : packing.radius) solid += particle_size<D>(r);
  const double side = edge_of<D>(solid / volume_fraction<D>);
  for (std::size_t k = 0; k < D; ++k) packing.cell[(D + 1) * k] = side;
  packing.position.resize(D * n);

  // Large particles first, since they fit in fewer positions.
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return packing.radius[a] > packing.radius[b];
  });
  Placed<D> placed(side, options.radius_max);
  for (const std::size_t p : order) {
    int trials = 0;
    Vec<D> position{};
    do {
      if (++trials > most_trials)
        throw Error(GRAINLAW_BAD_PACKING,
                    fmt::format("generator: no room for a {}; the radii differ too much",
                                D == 2 ? "disc" : "sphere"));
      for (double& component : position) component = side * unit_double(engine);
    } while (!placed.fits(position, packing.radius[p]));
    placed.add(position, packing.radius[p]);
    for (std::size_t k = 0; k < D; ++k) packing.position[k * n + p] = position[k];
  }
  return packing;
}

template Packing scatter<2>(const GeneratorOptions&);
template Packing scatter<3>(const GeneratorOptions&);

}  // namespace grainlaw::core

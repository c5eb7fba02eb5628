#include "generate/lubachevsky_stillinger.hpp"

#include "base/error.hpp"
#include "generate/disc_growth.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grainlaw::core {

namespace {

void check(const GeneratorOptions& options) {
  const auto require = [](bool right, const char* name, double value, const char* expected) {
    if (!right)
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("generator: {} = {}, expected {}", name, value, expected));
  };
  require(options.count >= 2, "count", static_cast<double>(options.count), "2 particles or more");
  require(options.growth_rate >= 1e-5 && options.growth_rate <= 1, "growth_rate",
          options.growth_rate, "a number from 1e-5 to 1");
  require(options.growth_end == 0 ||
              (options.growth_end > DiscGrowth::start_fraction && options.growth_end < 1),
          "volume_fraction", options.growth_end, "a number above 0.3 and below 1");
}

}  // namespace

Packing grow(const GeneratorOptions& options) {
  check(options);
  // Scattered discs cover more than growth starts from.
  Packing packing = scatter(options);
  std::mt19937_64 engine(options.seed);
  DiscGrowth growth(options, packing.radius);
  growth.place(packing, engine);
  const bool jammed = growth.run();
  const double scale = growth.free_scale();
  if (jammed && options.growth_end > 0)
    throw Error(GRAINLAW_BAD_PACKING,
                fmt::format("generator: the discs jam at a volume fraction of {:.4f}, expected "
                            "volume_fraction = {} to lie below it",
                            scale * scale, options.growth_end));
  // In a box of side 1 the solid area is scale^2.
  double solid = 0;
  for (const double r : packing.radius) solid += particle_size<2>(r);
  const double side = std::sqrt(solid) / scale;
  packing.cell = {side, 0, 0, side};
  const std::size_t n = packing.size();
  for (std::size_t p = 0; p < n; ++p) {
    packing.position[p] = growth.discs()[p].x * side;
    packing.position[n + p] = growth.discs()[p].y * side;
  }
  return packing;
}

}  // namespace grainlaw::core

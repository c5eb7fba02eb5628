#include "generate/lubachevsky_stillinger.hpp"

#include "base/error.hpp"
#include "generate/generator_checks.hpp"
#include "generate/growth.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

namespace grainlaw::core {

namespace {

template <int D>
void check(const GeneratorOptions& options) {
  if (options.count < 2) wrong("count", static_cast<double>(options.count), "2 particles or more");
  if (!(options.growth_rate >= 1e-5 && options.growth_rate <= 1))
    wrong("growth_rate", options.growth_rate, "a number from 1e-5 to 1");
  const double end = options.growth_end;
  if (end != 0 && !(end > Growth<D>::start_fraction && end < 1))
    wrong("volume_fraction", end,
          fmt::format("a number above {} and below 1", Growth<D>::start_fraction));
}

}  // namespace

template <int D>
Packing grow(const GeneratorOptions& options) {
  check<D>(options);
  // Scattered particles fill more than the start of growth does.
  Packing packing = scatter<D>(options);
  std::mt19937_64 engine(options.seed);
  Growth<D> growth(options, packing.radius);
  growth.begin(packing, engine);
  const bool jammed = growth.run();
  const double scale = growth.free_scale();
  if (jammed && options.growth_end > 0)
    throw Error(GRAINLAW_BAD_PACKING,
                fmt::format("generator: the {} jam at a volume fraction of {:.4f}, expected "
                            "volume_fraction = {} to lie below it",
                            D == 2 ? "discs" : "spheres", scale * scale * (D == 2 ? 1 : scale),
                            options.growth_end));
  // The solid size in a box of side 1 is scale^D.
  double solid = 0;
  for (const double r : packing.radius) solid += particle_size<D>(r);
  const double side = edge_of<D>(solid) / scale;
  const std::size_t n = packing.size();
  for (std::size_t k = 0; k < D; ++k) {
    packing.cell[(D + 1) * k] = side;
    for (std::size_t p = 0; p < n; ++p) {
      packing.position[k * n + p] = growth.particles()[p].position[k] * side;
    }
  }
  return packing;
}

template Packing grow<2>(const GeneratorOptions&);
template Packing grow<3>(const GeneratorOptions&);

}  // namespace grainlaw::core

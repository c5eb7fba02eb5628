#include "material/start_advice.hpp"

#include "homogenise/stress.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

namespace grainlaw::core {

namespace {

template <int D>
std::string expectation(const Increment<D>& increment, bool from_files) {
  constexpr double soft = 30, stiff = 1e7;       // kn / p outside are hardly meant
  constexpr double sparse = 0.3, crowded = 1.2;  // share of the cell that particles fill
  const Packing& packing = *increment.problem().packing;
  const BoundarySpace<D>& space = *increment.problem().space;
  const double r = mean_radius(packing.radius);
  const double kn = increment.problem().law->stiffness(r, r);
  const double pressure = -1.0 / D * trace<D>(piola_stress(increment));
  const double ratio = kn / (pressure * depth<D>(packing));
  const double filled = space.solid_volume / space.reference_volume;
  std::string text = fmt::format("mean pressure {:.3g} Pa, kn {:.3g} N/m", pressure, kn);
  if (filled < sparse || filled > crowded)
    return text + fmt::format(": particles fill {:.2g} of the cell; expected their own cell, in m",
                              filled);
  if (!(pressure > 0)) return text + ": it does not bear; expected a denser packing";
  text += fmt::format(", kn/p {:.3g}", ratio);
  if (ratio < soft) return text + ", soft: expected stiffer contacts or smaller overlaps";
  if (ratio > stiff)
    return text + fmt::format(", stiff: expected {}softer contacts or a packing under more load",
                              from_files ? "the cell of these particles, " : "");
  return text + "; expected a packing made with these contacts and friction, and its contacts file";
}

std::string made_with_more_friction(const MaterialDescription& description) {
  const auto& generator = description.generator;
  if (!generator || !(generator->friction > description.law.friction)) return {};
  return fmt::format("; made with packing.friction = {}, which contact.friction = {} may not hold",
                     generator->friction, description.law.friction);
}

}  // namespace

template <int D>
std::string start_advice(const Increment<D>& increment, const MaterialDescription& description) {
  return expectation(increment, !description.generator) + made_with_more_friction(description);
}

template std::string start_advice(const Increment<2>&, const MaterialDescription&);
template std::string start_advice(const Increment<3>&, const MaterialDescription&);

}  // namespace grainlaw::core

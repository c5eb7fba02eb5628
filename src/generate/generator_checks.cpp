#include "generate/generator_checks.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace grainlaw::core {

void wrong(const char* name, double value, const std::string& expected) {
  throw Error(GRAINLAW_BAD_PACKING,
              fmt::format("generator: {} = {}, expected {}", name, value, expected));
}

template <int D>
void check_target(const GeneratorOptions& options, const ContactLaw& law, double radius) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (options.void_ratio != 0) {
    if (!positive(options.void_ratio))
      wrong("void_ratio", options.void_ratio, "a finite number > 0");
  } else {
    if (!positive(options.pressure)) wrong("pressure", options.pressure, "a finite number > 0");
    // p t / kn of equal discs over their relative overlap, from p V = 1/2 sum fn d. The thickness
    // of spheres is one diameter.
    const double thickness = D == 2 ? options.thickness : 2 * radius;
    const char* length = D == 2 ? "thickness" : "diameter";
    const double stiffness = law.stiffness(radius, radius) / thickness;
    const double most = most_overlap * stiffness, least = least_overlap * stiffness;
    if (options.pressure > most)
      wrong("pressure", options.pressure,
            fmt::format("at most {:.6g} Pa, a fifth of kn / {}", most, length));
    if (!law.hertzian() && options.pressure < least)
      wrong("pressure", options.pressure,
            fmt::format("at least {:.6g} Pa, {:g} of kn / {}: smaller overlaps drown in rounding",
                        least, least_overlap, length));
  }
  if (!(options.friction >= 0) || !std::isfinite(options.friction))
    wrong("friction", options.friction, "a number >= 0");
}

template void check_target<2>(const GeneratorOptions&, const ContactLaw&, double);
template void check_target<3>(const GeneratorOptions&, const ContactLaw&, double);

}  // namespace grainlaw::core

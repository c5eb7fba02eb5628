#include "generate/compaction.hpp"

#include "base/error.hpp"
#include "generate/anisotropic.hpp"
#include "generate/compression.hpp"
#include "generate/lubachevsky_stillinger.hpp"
#include "generate/regular.hpp"
#include "generate/stress_control.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

// Beyond this kn / (p t) compression does not end at rest for every seed.
constexpr double stiffest_compression = 1e3;
// The most that neighbours may overlap, of their distance at first touch: contact laws of discs mean
// small overlaps.
constexpr double most_overlap = 0.2;
constexpr double faded_force = 1e-3;  // of the mean force at the target

[[noreturn]] void wrong(const char* name, double value, const std::string& expected) {
  throw Error(GRAINLAW_BAD_PACKING,
              fmt::format("generator: {} = {}, expected {}", name, value, expected));
}

// Divided once: packings made before keep their bits.
double mean_of(const std::vector<double>& radius) {
  return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
}

double solid_area(const Packing& packing) {
  double sum = 0;
  for (const double r : packing.radius) sum += particle_size<2>(r);
  return sum;
}

// Overlap / radius of Hertz-Mindlin contacts at a pressure: with 2 n contacts of branches 2 R, p V =
// sum fn 2 R / 2.
double overlap_at(double pressure, const Packing& packing, const ContactLaw& law) {
  const double radius = mean_of(packing.radius);
  const double force = pressure * packing.thickness * solid_area(packing) /
                       (2 * static_cast<double>(packing.size()) * radius);
  return std::pow(1.5 * force / law.coefficient(radius, radius), 2.0 / 3) / radius;
}

double cell_area(const Packing& packing) { return determinant<2>(packing.cell.data()); }

// p t / kn of equal discs, over their relative overlap: p V = 1/2 sum fn d.
double largest_pressure(const GeneratorOptions& options, const ContactLaw& law, double radius) {
  return most_overlap * law.stiffness(radius, radius) / options.thickness;
}

void check(const GeneratorOptions& options, const ContactLaw& law, double radius) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (options.void_ratio != 0) {
    if (!positive(options.void_ratio))
      wrong("void_ratio", options.void_ratio, "a finite number > 0");
  } else {
    if (!positive(options.pressure)) wrong("pressure", options.pressure, "a finite number > 0");
    const double most = largest_pressure(options, law, radius);
    if (options.pressure > most)
      wrong("pressure", options.pressure,
            fmt::format("at most {:.6g} Pa, a fifth of kn / thickness", most));
  }
  if (!(options.friction >= 0) || !std::isfinite(options.friction))
    wrong("friction", options.friction, "a number >= 0");
}

// The overlap of equal discs in a lattice under p t = share fn / distance [m].
double lattice_overlap(const ContactLaw& law, double radius, double load, double share) {
  double low = 0;
  double high = most_overlap * 2 * radius;
  for (int halving = 0; halving < 100; ++halving) {
    const double overlap = 0.5 * (low + high);
    const double force = share * law.normal_force(radius, radius, overlap);
    (force > load * (2 * radius - overlap) ? high : low) = overlap;
  }
  return high;
}

// Square: p t = fn / d, hexagonal: p t = sqrt(3) fn / d.
Packing make_regular(const GeneratorOptions& options, const ContactLaw& law) {
  const double radius = options.radius_max;
  const double diameter = 2 * radius;
  const bool square = options.kind == GeneratorKind::square;
  double overlap = options.overlap.value_or(0);
  if (!options.overlap) {
    check(options, law, radius);
    overlap = lattice_overlap(law, radius, options.pressure * options.thickness,
                              square ? 1 : std::numbers::sqrt3);
  }
  if (!(overlap >= 0 && overlap < most_overlap * diameter))
    wrong("overlap", overlap, fmt::format("a length >= 0 and below {} m", most_overlap * diameter));
  const double distance = diameter - overlap;
  Packing packing = square ? square_lattice(options.columns, options.rows, radius, distance)
                           : hexagonal_lattice(options.columns, options.rows, radius, distance);
  std::mt19937_64 engine(options.seed);
  if (options.radius_spread > 0)
    for (double& r : packing.radius) r *= 1 + options.radius_spread * (2 * unit_double(engine) - 1);
  packing.thickness = options.thickness;
  packing.density = options.density;
  return packing;
}

// Consolidation of loose discs.
class Consolidation {
 public:
  Consolidation(const Packing& loose, const GeneratorOptions& options, const ContactLaw& law)
      : loose_(loose), options_(options), law_(law), radius_(mean_of(loose.radius)) {}

  // Compression finds rest the easier the softer the discs are against the pressure; the way down
  // from there is another for each.
  Packing run() {
    const double line_stiffness = law_.stiffness(radius_, radius_) / options_.thickness;  // [Pa]
    const bool to_pressure = !(options_.void_ratio > 0);
    std::vector<double> above;  // pressures to come down from
    for (const double stiffness : {1.0, 0.3, 0.1, 0.03}) {
      const double pressure = line_stiffness / (stiffness * stiffest_compression);
      if (!to_pressure || pressure > options_.pressure) above.push_back(pressure);
    }
    // Compressed to a void ratio the discs may not have met yet, where those come down to it bear.
    std::optional<Error> loose;
    if (!to_pressure || options_.pressure * stiffest_compression >= line_stiffness) {
      try {
        return finish(compress(loose_, options_, law_), options_.pressure, false);
      } catch (const Error& error) {
        if (above.empty()) throw;
        if (error.status != GRAINLAW_NOT_CONVERGED) loose = error;
      }
    }
    for (std::size_t k = 0;; ++k) {
      try {
        GeneratorOptions soft = options_;
        soft.void_ratio = 0;
        soft.pressure = above[k];
        return finish(compress(loose_, soft, law_), above[k], true);
      } catch (const Error& error) {
        const bool last = k + 1 == above.size();
        if (loose && (last || error.status != GRAINLAW_NOT_CONVERGED)) throw *loose;
        if (last || error.status != GRAINLAW_NOT_CONVERGED) throw;
      }
    }
  }

 private:
  Packing finish(Configuration<2> at, double pressure, bool unload) const {
    if (!unload && !(options_.anisotropy >= 0)) {
      const BoundarySpace<2> space = make_cell_space<2>(loose_);
      return packing_of({&loose_, &law_, &space}, at);
    }
    StressTarget target;
    target.pressure = options_.pressure;
    const double solid = solid_area(loose_);
    if (options_.void_ratio > 0) {
      target.volume = (1 + options_.void_ratio) * solid / cell_area(loose_);
    } else {
      pressure = options_.pressure;
    }
    const double mean_force =
        pressure * options_.thickness * solid / (2 * static_cast<double>(loose_.size()) * radius_);
    StressControl control(loose_, law_, std::move(at), faded_force * mean_force);
    if (unload && !control.reach(target))
      throw Error(
          GRAINLAW_NOT_CONVERGED,
          fmt::format("generator: no packing at rest was found on unloading; pressure "
                      "{:.6g} Pa, void ratio {:.6g}; try another seed",
                      control.pressure(), control.volume() * cell_area(loose_) / solid - 1));
    if (options_.anisotropy >= 0)
      consolidate_anisotropically(control, target, options_.anisotropy,
                                  options_.anisotropy_direction);
    return packing_of(control.problem(), control.configuration());
  }

  const Packing& loose_;
  const GeneratorOptions& options_;
  const ContactLaw& law_;
  double radius_;  // mean [m]
};

Packing make_random(const GeneratorOptions& options, const ContactLaw& material_law) {
  check(options, material_law, 0.5 * (options.radius_min + options.radius_max));
  ContactLaw law = material_law;
  law.friction = options.friction;
  if (law.bonds()) law.kind = LawKind::frictional;  // bonds come with F = I
  const Packing loose =
      options.kind == GeneratorKind::lubachevsky_stillinger ? grow(options) : scatter(options);
  if (law.hertzian() && options.pressure > 0) {
    law.typical_overlap = overlap_at(options.pressure, loose, law);
  }
  return Consolidation(loose, options, law).run();
}

}  // namespace

Packing consolidate(const GeneratorOptions& options, const ContactLaw& law) {
  const bool regular =
      options.kind == GeneratorKind::square || options.kind == GeneratorKind::hexagonal;
  return regular ? make_regular(options, law) : make_random(options, law);
}

}  // namespace grainlaw::core

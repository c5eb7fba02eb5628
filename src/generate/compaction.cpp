#include "generate/compaction.hpp"

#include "base/error.hpp"
#include "generate/anisotropic.hpp"
#include "generate/compression.hpp"
#include "generate/generator_checks.hpp"
#include "generate/lubachevsky_stillinger.hpp"
#include "generate/regular_at_pressure.hpp"
#include "generate/stress_control.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

// Largest kn / (p t) at which compression comes to rest for every seed.
constexpr double stiffest_compression = 1e3;
constexpr double zero_force_share = 1e-3;  // relative to the mean force at the target

// Mean with one division, which keeps the bits of earlier packings.
double mean_of(const std::vector<double>& radius) {
  return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
}

// Area or volume of all particles [m2, m3].
template <int D>
double solid_size(const Packing& packing) {
  double sum = 0;
  for (const double r : packing.radius) sum += particle_size<D>(r);
  return sum;
}

// Overlap / radius of Hertz-Mindlin contacts at a pressure, from p V = sum fn 2 R / D over D n
// contacts of branches 2 R.
template <int D>
double overlap_at(double pressure, const Packing& packing, const ContactLaw& law) {
  const double radius = mean_of(packing.radius);
  const double force = pressure * packing.thickness * solid_size<D>(packing) /
                       (2 * static_cast<double>(packing.size()) * radius);
  return std::pow(1.5 * force / law.coefficient(radius, radius), 2.0 / 3) / radius;
}

template <int D>
double cell_size(const Packing& packing) {
  return determinant<D>(packing.cell.data());
}

template <int D>
class Consolidation {
 public:
  Consolidation(const Packing& loose, const GeneratorOptions& options, const ContactLaw& law)
      : loose_(loose), options_(options), law_(law), radius_(mean_of(loose.radius)) {}

  // Compresses directly, or to a higher pressure and unloads. Soft particles, relative to the
  // pressure, come to rest more easily; each start pressure gives another way down.
  Packing run() {
    const double line_stiffness = law_.stiffness(radius_, radius_) / depth<D>(loose_);  // [Pa]
    const bool to_pressure = !(options_.void_ratio > 0);
    std::vector<double> above;  // pressures to unload from
    for (const double stiffness : {1.0, 0.3, 0.1, 0.03}) {
      const double pressure = line_stiffness / (stiffness * stiffest_compression);
      if (!to_pressure || pressure > options_.pressure) above.push_back(pressure);
    }
    // Error of the direct compression: particles may not touch at the void ratio yet, and may bear
    // load once unloaded to it.
    std::optional<Error> loose;
    if (!to_pressure || options_.pressure * stiffest_compression >= line_stiffness) {
      try {
        return finish(compress<D>(loose_, options_, law_), options_.pressure, false);
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
        return finish(compress<D>(loose_, soft, law_), above[k], true);
      } catch (const Error& error) {
        const bool last = k + 1 == above.size();
        if (loose && (last || error.status != GRAINLAW_NOT_CONVERGED)) throw *loose;
        if (last || error.status != GRAINLAW_NOT_CONVERGED) throw;
      }
    }
  }

 private:
  Packing finish(Configuration<D> at, double pressure, bool unload) const {
    if (!unload && !(options_.anisotropy >= 0)) {
      const BoundarySpace<D> space = make_cell_space<D>(loose_);
      return packing_of<D>({&loose_, &law_, &space}, at);
    }
    StressTarget<D> target;
    target.pressure = options_.pressure;
    const double solid = solid_size<D>(loose_);
    if (options_.void_ratio > 0) {
      target.volume = (1 + options_.void_ratio) * solid / cell_size<D>(loose_);
    } else {
      pressure = options_.pressure;
    }
    const double mean_force =
        pressure * loose_.thickness * solid / (2 * static_cast<double>(loose_.size()) * radius_);
    StressControl<D> control(loose_, law_, std::move(at), zero_force_share * mean_force);
    if (unload && !control.reach(target))
      throw Error(
          GRAINLAW_NOT_CONVERGED,
          fmt::format("generator: no packing at rest was found on unloading; pressure "
                      "{:.6g} Pa, void ratio {:.6g}; try another seed",
                      control.pressure(), control.volume() * cell_size<D>(loose_) / solid - 1));
    if (options_.anisotropy >= 0) consolidate_anisotropically(control, target, options_);
    return packing_of(control.problem(), control.configuration());
  }

  const Packing& loose_;
  const GeneratorOptions& options_;
  const ContactLaw& law_;
  double radius_;  // mean radius [m]
};

template <int D>
Packing make_with_friction(const GeneratorOptions& options, const ContactLaw& material_law) {
  check_target<D>(options, material_law, 0.5 * (options.radius_min + options.radius_max));
  ContactLaw law = material_law;
  law.friction = options.friction;
  if (law.bonds()) law.kind = LawKind::frictional;  // bonds come with F = I
  const Packing loose = options.kind == GeneratorKind::lubachevsky_stillinger ? grow<D>(options)
                                                                              : scatter<D>(options);
  if (law.hertzian() && options.pressure > 0) {
    law.typical_overlap = overlap_at<D>(options.pressure, loose, law);
  }
  return Consolidation<D>(loose, options, law).run();
}

// At a pressure the void ratio rises with the friction, in jumps of few particles: bisection.
template <int D>
Packing find_friction(const GeneratorOptions& options, const ContactLaw& law) {
  constexpr double close = 1e-3;  // of 1 + void ratio
  constexpr int most_trials = 16;
  GeneratorOptions trial = options;
  trial.void_ratio = 0;
  double found = 0;
  const auto make = [&](double friction) {
    trial.friction = friction;
    Packing packing = make_with_friction<D>(trial, law);
    found = cell_size<D>(packing) / solid_size<D>(packing) - 1;
    return packing;
  };
  const auto met = [&] {
    return std::abs(found - options.void_ratio) <= close * (1 + options.void_ratio);
  };
  double low = 0, high = law.friction;
  Packing packing = make(low);
  if (met()) return packing;
  const double densest = found;
  packing = make(high);
  if (met()) return packing;
  const double loosest = found;
  if (options.void_ratio < densest || options.void_ratio > loosest)
    wrong("void_ratio", options.void_ratio,
          fmt::format(
              "{:.4f} to {:.4f} at {:.6g} Pa: what friction from 0 to contact.friction while the "
              "packing is made allows",
              densest, loosest, options.pressure));
  for (int k = 0; k < most_trials; ++k) {
    const double middle = 0.5 * (low + high);
    packing = make(middle);
    if (met()) return packing;
    (found < options.void_ratio ? low : high) = middle;
  }
  throw Error(
      GRAINLAW_NOT_CONVERGED,
      fmt::format("generator: void_ratio = {} at {:.6g} Pa was not met, found {:.4f}; try another "
                  "seed or more {}",
                  options.void_ratio, options.pressure, found, D == 2 ? "discs" : "spheres"));
}

template <int D>
Packing make_random(const GeneratorOptions& options, const ContactLaw& law) {
  return options.finds_friction ? find_friction<D>(options, law)
                                : make_with_friction<D>(options, law);
}

}  // namespace

template <int D>
Packing consolidate(const GeneratorOptions& options, const ContactLaw& law) {
  return options.regular() ? make_regular<D>(options, law) : make_random<D>(options, law);
}

template Packing consolidate<2>(const GeneratorOptions&, const ContactLaw&);
template Packing consolidate<3>(const GeneratorOptions&, const ContactLaw&);

}  // namespace grainlaw::core

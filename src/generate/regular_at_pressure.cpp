#include "generate/regular_at_pressure.hpp"

#include "generate/generator_checks.hpp"
#include "generate/regular.hpp"
#include "generate/sphere_lattices.hpp"

#include <fmt/format.h>

#include <numbers>
#include <random>

namespace grainlaw::core {

namespace {

// Neighbour force under a pressure: p t = share fn / distance for discs, p = share fn / distance^2
// for spheres.
struct Lattice {
  double share, load;
  double most_overlap;  // [diameter]
};

template <int D>
Lattice lattice_of(const GeneratorOptions& options) {
  if constexpr (D == 3) {
    return {pressure_share(options.kind), options.pressure, most_lattice_overlap(options.kind)};
  } else {
    const bool square = options.kind == GeneratorKind::square;
    return {square ? 1 : std::numbers::sqrt3, options.pressure * options.thickness, most_overlap};
  }
}

// Overlap of equal particles under the pressure [m].
template <int D>
double overlap_under(const Lattice& lattice, const ContactLaw& law, double radius) {
  double low = 0;
  double high = lattice.most_overlap * 2 * radius;
  for (int halving = 0; halving < 100; ++halving) {
    const double overlap = 0.5 * (low + high);
    const double force = lattice.share * law.normal_force(radius, radius, overlap);
    const double distance = 2 * radius - overlap;
    const double section = D == 2 ? distance : distance * distance;
    (force > lattice.load * section ? high : low) = overlap;
  }
  return high;
}

template <int D>
Packing lattice_at(const GeneratorOptions& options, double distance) {
  const double radius = options.radius_max;
  if constexpr (D == 3) {
    return sphere_lattice(options.kind, options.cells, radius, distance);
  } else {
    Packing packing = options.kind == GeneratorKind::square
                          ? square_lattice(options.columns, options.rows, radius, distance)
                          : hexagonal_lattice(options.columns, options.rows, radius, distance);
    packing.thickness = options.thickness;
    return packing;
  }
}

}  // namespace

template <int D>
Packing make_regular(const GeneratorOptions& options, const ContactLaw& law) {
  const double radius = options.radius_max;
  const double diameter = 2 * radius;
  const Lattice lattice = lattice_of<D>(options);
  double overlap = options.overlap.value_or(0);
  if (!options.overlap) {
    check_target<D>(options, law, radius);
    overlap = overlap_under<D>(lattice, law, radius);
  }
  if (!(overlap >= 0 && overlap < lattice.most_overlap * diameter))
    wrong("overlap", overlap,
          fmt::format("a length >= 0 and below {} m", lattice.most_overlap * diameter));
  Packing packing = lattice_at<D>(options, diameter - overlap);
  std::mt19937_64 engine(options.seed);
  if (options.radius_spread > 0)
    for (double& r : packing.radius) r *= 1 + options.radius_spread * (2 * unit_double(engine) - 1);
  packing.density = options.density;
  return packing;
}

template Packing make_regular<2>(const GeneratorOptions&, const ContactLaw&);
template Packing make_regular<3>(const GeneratorOptions&, const ContactLaw&);

}  // namespace grainlaw::core

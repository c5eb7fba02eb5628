// Cases in which P is known: closed forms, a rattler that must not matter, and units.

#include "evidence/studies/stability/cases.hpp"
#include "evidence/studies/stability/closed_forms.hpp"
#include "evidence/studies/stability/paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification::stability {
namespace {

constexpr double exact = 1e-7;  // bar for closed forms; equilibria are taken to 1e-10
constexpr double tight = 1e-10;
constexpr double diameter = 1e-2;       // of the lattices' discs [m]
constexpr double first_overlap = 2e-5;  // [m]

// Compression with shear and rotation, then extension until the contacts along x open.
Targets lattice_path() {
  Tensor compression;
  compression << -0.01, 0.006, -0.003, -0.012;
  Tensor extension;
  extension << 0.012, -0.004, 0.004, -0.006;
  Targets targets =
      along(40, [&](double s) { return (Tensor::Identity() + s * compression).eval(); });
  const Tensor corner = targets.back();
  for (const Tensor& step : along(60, [&](double s) { return (corner + s * extension).eval(); }))
    targets.push_back(step);
  return targets;
}

void add_lattices(const PackingStore& store, Cases& cases) {
  const double distance = diameter - first_overlap;
  for (const int discs : {2, 3})
    for (const double friction : {0.0, 0.02, 0.3, 1e3}) {
      const Contact contact{.friction = friction, .tolerance = tight};
      const std::string name = fmt::format("lattice{}", discs);
      add(
          cases, "closed form", fmt::format("lattice of {} discs, friction {:g}", discs, friction),
          [=] { return store.tiny(name, lattice(discs, distance), contact); },
          {.targets = lattice_path()},
          [=](const Walk& walk) {
            const double error =
                stress_distance(walk.points, lattice_stress(walk.points, distance, contact));
            const bool split =
                friction > 0 && std::any_of(walk.points.begin(), walk.points.end(),
                                            [](const Point& point) { return !point.in_one_part; });
            return Check{error, split ? 1e-2 : exact,
                         split ? "the closed form, not the same parts" : "the closed form"};
          });
    }
  // Nothing presses: no stress to be in equilibrium with, or almost none.
  for (const double overlap : {0.0, 1e-8, 1e-5}) {
    const Contact contact{.friction = 0, .tolerance = tight};
    const double touching = diameter * (1 - overlap);
    add(
        cases, "no pressure", fmt::format("lattice of 2 discs, overlap {:g} diameters", overlap),
        [=] { return store.tiny("lattice_touching", lattice(2, touching), contact); },
        {.targets = along(10, [](double s) { return isotropic(1 - 0.01 * s); })},
        [=](const Walk& walk) {
          return Check{stress_distance(walk.points, lattice_stress(walk.points, touching, contact)),
                       exact, "the closed form"};
        });
  }
}

void add_columns(const PackingStore& store, Cases& cases) {
  const auto stretch = [](double s) {
    Tensor f = Tensor::Identity();
    f(0, 0) = 1 + 0.02 * s;
    f(1, 1) = 1 - 0.01 * s;
    return f;
  };
  for (const auto& radii : {std::vector{5e-3, 3e-3}, std::vector{5e-3, 3e-3, 4e-3}}) {
    // Discs that may roll let a column buckle.
    const Contact contact{.rotation = false, .tolerance = tight};
    const TinyPacking packing = column(radii, contact.young, 1e3);
    add(
        cases, "closed form", fmt::format("column of {} discs, compression by 1 %", radii.size()),
        [=] { return store.tiny(fmt::format("column{}", radii.size()), packing, contact); },
        {.targets = along(20, stretch)},
        [=](const Walk& walk) {
          std::vector<Tensor> stresses;
          for (const Point& point : walk.points)
            stresses.push_back(column_stress(point.deformation, packing, contact.young));
          return Check{stress_distance(walk.points, stresses), exact, "springs in series"};
        });
  }
}

void add_rattler(const PackingStore& store, Cases& cases) {
  const Path path{.targets = along(10, [](double s) { return simple_shear(0.002 * s); })};
  add(
      cases, "rattlers", "one more, shear to 0.2 % by 0.02 %",
      [=] { return store.with_rattler({}, {.tolerance = 1e-8}); }, path,
      [=](const Walk& walk) {
        const Material plain = store.generated({}, {.tolerance = 1e-8});
        const Walk reference = stability::walk(plain, path);
        return Check{stress_distance(walk.points, stresses_of(reference)), 1e-5,
                     "the packing without it"};
      });
  add(cases, "rattlers", "5 x 5 discs of sizes 1 to 10, shear to 1 % by 0.1 %",
      [=] { return store.generated({.size_ratio = 10, .count = 25}, {}); },
      {.targets = along(10, [](double s) { return simple_shear(0.01 * s); })});
}

void add_units(const PackingStore& store, Cases& cases) {
  struct System {
    const char* name;
    Units units;
    double bar;
  };
  const Path path{.targets = along(10, [](double s) { return isochoric(0.01 * s); })};
  // Chaos has not begun at 1 %: rounding stays rounding.
  for (const System& system :
       {System{"mm, N, MPa", {1e3, 1e-6}, 1e-6}, System{"um, uN, MPa", {1e6, 1e-6}, 1e-6},
        System{"um, N, TPa", {1e6, 1e-12}, 1e-6}, System{"km, GPa", {1e-3, 1e-9}, 1e-6},
        System{"length x 2^10, modulus x 2^-16", {0x1p10, 0x1p-16}, 1e-6},
        System{"modulus x 2^40, to the bits", {1, 0x1p40}, 0}}) {
    const Contact contact{.tolerance = 1e-8};
    add(
        cases, "units", system.name, [=] { return store.in_units({}, contact, system.units); },
        path,
        [=](const Walk& walk) {
          const Material plain = store.in_units({}, contact, {});
          std::vector<Tensor> scaled = stresses_of(stability::walk(plain, path));
          for (Tensor& stress : scaled) stress *= system.units.modulus;
          return Check{stress_distance(walk.points, scaled), system.bar, "SI"};
        });
  }
}

}  // namespace

void add_exact_cases(const PackingStore& store, Cases& cases) {
  add_lattices(store, cases);
  add_columns(store, cases);
  add_rattler(store, cases);
  add_units(store, cases);
}

}  // namespace verification::stability

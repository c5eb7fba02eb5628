// Extreme deformation: large, turning, cyclic, random, in large steps, to no contacts and back.

#include "evidence/studies/stability/cases.hpp"
#include "evidence/studies/stability/paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification::stability {
namespace {

using Maker = std::function<Material()>;

Tensor unmoved(double) { return Tensor::Identity(); }
Tensor small_shear(double s) { return simple_shear(0.01 * s); }

void add_large(const Maker& material, Cases& cases) {
  add(cases, "simple shear", "F12 to 2 by 1 %", material,
      {.targets = along(200, [](double s) { return simple_shear(2 * s); })});
  add(cases, "isochoric cycles", "5 of 0.5 % by 0.05 %", material,
      {.targets = cycles(5, 10, [](double s) { return isochoric(0.005 * s); })});
  add(cases, "isochoric cycles", "3 of 3 % by 0.3 %", material,
      {.targets = cycles(3, 10, [](double s) { return isochoric(0.03 * s); })});
  // The radii are 5 mm on average: the overlap is given in diameters.
  add(cases, "compression", "isotropic to 30 % mean overlap by 1 %", material,
      {.targets = along(55, [](double s) { return isotropic(1 - 0.55 * s); })},
      [](const Walk& walk) {
        const double overlap = walk.mean_overlap / 1e-2;
        return Check{0, 1, fmt::format("mean overlap {:.3f} diameters", overlap)};
      });
  add(cases, "increments of 10 %", "simple shear to 1", material,
      {.targets = along(10, simple_shear<2>)});
  add(cases, "increments of 10 %", "isochoric to 0.5", material,
      {.targets = along(5, [](double s) { return isochoric(0.5 * s); })});
  add(cases, "increments of 10 %", "isotropic compression to 0.7", material,
      {.targets = along(3, [](double s) { return isotropic(1 - 0.3 * s); })});
  add(cases, "too large", "isochoric 40 % at once", material, {.targets = {isochoric(0.4)}});
  Tensor mirrored = Tensor::Identity();
  mirrored(0, 0) = -1;
  add(cases, "too large", "F mirrored", material, {.targets = {mirrored}});
}

void add_rotations(const PackingStore& store, Cases& cases) {
  const Maker material = [store] { return store.generated({}, {.tolerance = 1e-8}); };
  for (const double angle : {0.3, 1.0, 3.0}) {
    const auto rotating_by = [&](const char* what,
                                 const std::function<Tensor(double)>& deformation) {
      const Targets still = along(steps_of_turns(angle, 10), deformation);
      add(cases, "10 turns", fmt::format("steps of {:g} rad, {}", angle, what), material,
          {.targets = rotated<2>(angle, still)},
          [=](const Walk& walk) { return against_unrotated<2>(material(), walk, angle, still); });
    };
    rotating_by("rigid", unmoved);
    rotating_by("with shear to 1 %", small_shear);
  }
}

void add_random(const PackingStore& store, Cases& cases) {
  const Maker material = [store] { return store.generated({.count = 49}, {}); };
  unsigned seed = 1;
  for (const double size : {1e-4, 1e-3, 1e-2, 5e-2})
    add(cases, "random F", fmt::format("2500 increments up to {:g}, within 10 %", size), material,
        {.targets = random_walk(seed++, 2500, size, 0.1),
         .surrender = Surrender::skip_the_increment,
         .zero_stress_when_lost = true,
         .cpu_budget = 40});
}

void add_dilution(const PackingStore& store, Cases& cases) {
  const Maker material = [store] { return store.generated({}, {}); };
  for (const double strain : {0.01, 0.1, 0.25})
    for (const int quarter : {1, 20}) {
      const auto expand = [=](double s) { return isotropic(1 + strain * s); };
      add(cases, "dilution and back",
          fmt::format("stretch {:g}, {} increments each way", strain, quarter), material,
          {.targets = there_and_back(quarter, expand), .zero_stress_when_lost = true},
          bears_again<2>);
    }
  // About as wide as the packing bears at all, so that forces come, fade and go.
  for (const double stretch : {0.004, 0.005, 0.0052, 0.0053, 0.0054, 0.006}) {
    Targets targets = along(4, [=](double s) { return isotropic(1 + stretch * s); });
    const auto sheared = [=](double s) -> Tensor {
      return simple_shear(0.01 * s) * isotropic(1 + stretch);
    };
    for (const Tensor& target : cycles(1, 10, sheared)) targets.push_back(target);
    add(cases, "hardly bearing",
        fmt::format("400 discs, stretch {:g}, cycle of shear of 1 % by 0.1 %", stretch),
        [store] {
          return store.generated({.count = 400}, {.tolerance = 1e-7, .stress_free = true});
        },
        {.targets = targets, .cpu_budget = 60});
  }
  add(cases, "no pressure", "from the last contacts, compression by 1 %, 0.1 %",
      [store] { return store.barely_touching({}, {}); },
      {.targets = along(10, [](double s) { return isotropic(1 - 0.01 * s); })});
  add(cases, "no pressure", "from the last contacts, shear by 1 %, 0.1 %",
      [store] { return store.barely_touching({}, {}); },
      {.targets = along(10, small_shear), .zero_stress_when_lost = true});
}

// Friction is dissipated by whole increments and the work is a trapezoid: the error is of first
// order in the increment. Without friction nothing is dissipated, but what jumps between equilibria
// release does not fall with the increment.
void add_energy(const PackingStore& store, const MaterialSource& yade, Cases& cases) {
  for (const int steps : {15, 60, 240})
    add(cases, "energy", fmt::format("friction 0, shear to 1.5 % and back by {:g} %", 1.5 / steps),
        [=] { return store.generated({}, {.friction = 0}); },
        {.targets = cycles(1, steps, [](double s) { return simple_shear(0.015 * s); })});
  const Maker material = [yade] { return make_material(yade); };
  for (const int steps : {10, 20, 40})
    add(cases, "energy", fmt::format("400 discs, shear to 1 % by {:g} %", 1.0 / steps), material,
        {.targets = along(steps, small_shear)});
  add(cases, "400 discs", "isochoric to 5 % by 0.1 %", material,
      {.targets = along(50, [](double s) { return isochoric(-0.05 * s); })});
}

}  // namespace

void add_path_cases(const PackingStore& store, const MaterialSource& yade, Cases& cases) {
  const Maker material = [store] { return store.generated({}, {}); };
  add_large(material, cases);
  add_dilution(store, cases);
  add_rotations(store, cases);
  add_random(store, cases);
  add_energy(store, yade, cases);
}

}  // namespace verification::stability

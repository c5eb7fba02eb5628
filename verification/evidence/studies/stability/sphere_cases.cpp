// Spheres through what discs go through. What must converge: increments of at most 0.1 %, or 0.3
// p/kn, of packings with friction of 0.1 to 1.5 that keep their contacts; compression; turns; and
// closed forms. Of all else a documented status will do.

#include "evidence/studies/stability/cases.hpp"
#include "evidence/studies/stability/paths.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace verification::stability {
namespace {

using Space = TensorOf<3>;
using Maker = std::function<Material()>;

constexpr bool must = true;
constexpr bool may = false;
const Recipe usual{.count = 100, .dimension = 3};

Space unmoved(double) { return Space::Identity(); }
Space small_shear(double s) { return simple_shear<3>(0.01 * s); }

Recipe as_stiff_as(double stiffness) {
  Recipe recipe = usual;
  recipe.stiffness = stiffness;
  return recipe;
}

PathOf<3> shear_and_back(int quarter) {
  return {.targets = cycles(1, quarter, [](double s) { return simple_shear<3>(0.015 * s); }),
          .cpu_budget = 60};
}

void add_contacts(const PackingStore& store, Cases& cases) {
  for (int decade = 2; decade <= 6; ++decade) {
    const double stiffness = std::pow(10.0, decade);
    const Maker material = [=] { return store.generated(as_stiff_as(stiffness), {}); };
    add_spheres(
        cases, must, "kn/p", fmt::format("1e{}, isochoric, 40 increments of Pi = 0.3", decade),
        material,
        {.targets = along(40, [=](double s) { return isochoric<3>(40 * 0.3 / stiffness * s); })});
    add_spheres(
        cases, decade <= 4 ? must : may, "kn/p",
        fmt::format("1e{}, isochoric, 20 increments of 0.1 %", decade), material,
        {.targets = along(20, [](double s) { return isochoric<3>(0.02 * s); }), .cpu_budget = 60});
  }
  const auto sheared = [&](bool bar, const char* group, double value, const Recipe& recipe,
                           const Contact& contact) {
    add_spheres(
        cases, bar, group, fmt::format("{:g}, shear to 1.5 % and back, 0.1 %", value),
        [=] { return store.generated(recipe, contact); }, shear_and_back(15));
  };
  for (const double friction : {0.0, 0.1, 0.5, 1.5, 1e3})
    sheared(friction > 0 && friction < 1e3, "friction", friction, usual, {.friction = friction});
  for (const double ratio : {0.0, 0.2, 1.0, 2.0})
    sheared(must, "kt/kn", ratio, usual, {.ratio = ratio});
  sheared(must, "rotation locked", 1, usual, {.rotation = false});
  for (const double ratio : {1.0, 5.0}) {
    Recipe recipe = usual;
    recipe.size_ratio = ratio;
    sheared(must, "size ratio", ratio, recipe, {});
  }
}

void add_large(const Maker& material, Cases& cases) {
  add_spheres(cases, may, "simple shear", "F13 to 1 by 1 %", material,
              {.targets = along(100, simple_shear<3>), .cpu_budget = 60});
  add_spheres(cases, must, "isochoric cycles", "5 of 0.5 % by 0.05 %", material,
              {.targets = cycles(5, 10, [](double s) { return isochoric<3>(0.005 * s); }),
               .cpu_budget = 60});
  add_spheres(cases, may, "isochoric cycles", "3 of 3 % by 0.3 %", material,
              {.targets = cycles(3, 10, [](double s) { return isochoric<3>(0.03 * s); }),
               .cpu_budget = 60});
  add_spheres(
      cases, must, "compression", "isotropic to 0.7 by 1 %", material,
      {.targets = along(30, [](double s) { return isotropic<3>(1 - 0.3 * s); }), .cpu_budget = 60});
  add_spheres(
      cases, may, "increments of 10 %", "simple shear to 0.5", material,
      {.targets = along(5, [](double s) { return simple_shear<3>(0.5 * s); }), .cpu_budget = 60});
  add_spheres(cases, may, "too large", "isochoric 40 % at once", material,
              {.targets = {isochoric<3>(0.4)}});
  Space mirrored = Space::Identity();
  mirrored(0, 0) = -1;
  add_spheres(cases, may, "too large", "F mirrored", material, {.targets = {mirrored}});
}

void add_turns(const PackingStore& store, Cases& cases) {
  constexpr double angle = 1;
  const Maker material = [store] { return store.generated(usual, {.tolerance = 1e-8}); };
  const int steps = steps_of_turns(angle, 10);
  const auto turned = [&](const char* what, const TargetsOf<3>& still) {
    add_spheres(cases, must, "10 turns", fmt::format("steps of {:g} rad, {}", angle, what),
                material, {.targets = rotated<3>(angle, still), .cpu_budget = 60},
                [=](const WalkOf<3>& walk) {
                  return against_unrotated<3>(material(), walk, angle, still);
                });
  };
  turned("rigid", along(steps, unmoved));
  turned("with shear to 1 %", along(steps, small_shear));
}

void add_contacts_that_come_and_go(const PackingStore& store, Cases& cases) {
  const Maker material = [store] { return store.generated(usual, {}); };
  for (const double strain : {0.01, 0.1})
    add_spheres(
        cases, may, "dilution and back",
        fmt::format("stretch {:g}, 20 increments each way", strain), material,
        {.targets = there_and_back(20, [=](double s) { return isotropic<3>(1 + strain * s); }),
         .zero_stress_when_lost = true,
         .cpu_budget = 60},
        bears_again<3>);
  for (const double stretch : {0.002, 0.004}) {
    auto targets = along(4, [=](double s) { return isotropic<3>(1 + stretch * s); });
    const auto sheared = [=](double s) -> Space { return small_shear(s) * (1 + stretch); };
    for (const Space& target : cycles(1, 10, sheared)) targets.push_back(target);
    add_spheres(
        cases, may, "hardly bearing",
        fmt::format("stretch {:g}, cycle of shear of 1 % by 0.1 %", stretch),
        [store] { return store.generated(usual, {.tolerance = 1e-7, .stress_free = true}); },
        {.targets = targets, .cpu_budget = 60});
  }
  const Maker last = [store] { return store.barely_touching(usual, {}); };
  add_spheres(cases, may, "no pressure", "from the last contacts, compression by 1 %, 0.1 %", last,
              {.targets = along(10, [](double s) { return isotropic<3>(1 - 0.01 * s); })});
  add_spheres(cases, may, "no pressure", "from the last contacts, shear by 1 %, 0.1 %", last,
              {.targets = along(10, small_shear), .zero_stress_when_lost = true});
  unsigned seed = 1;
  for (const double size : {1e-3, 1e-2})
    add_spheres(cases, may, "random F", fmt::format("300 increments up to {:g}, within 10 %", size),
                material,
                {.targets = random_walk<3>(seed++, 300, size, 0.1),
                 .surrender = Surrender::skip_the_increment,
                 .zero_stress_when_lost = true,
                 .cpu_budget = 60});
}

// Each of 12 contacts of a sphere presses with kn (2 R - l), half of it its own.
void add_lattice(const PackingStore& store, Cases& cases) {
  constexpr double radius = 5e-3;
  constexpr double overlap = 2e-5;  // [m]
  const Contact contact{.tolerance = 1e-10};
  const double reference = 2 * radius - overlap;
  for (const double strain : {-0.02, 0.0015})
    add_spheres(
        cases, must, "closed form", fmt::format("face-centred lattice, stretch by {:g}", strain),
        [=] { return store.fcc(overlap, contact); },
        {.targets = along(20, [=](double s) { return isotropic<3>(1 + strain * s); })},
        [=](const WalkOf<3>& walk) {
          std::vector<Space> stresses;
          for (const PointOf<3>& point : walk.points) {
            const double length = reference * point.deformation(0, 0);
            const double force = contact.young * radius * (2 * radius - length);
            stresses.push_back(-2 * std::numbers::sqrt2 * force / (reference * reference) *
                               Space::Identity());
          }
          return Check{stress_distance(walk.points, stresses), 1e-7, "the closed form"};
        });
}

void add_energy(const PackingStore& store, Cases& cases) {
  for (const int quarter : {15, 60})
    add_spheres(
        cases, may, "energy",
        fmt::format("friction 0, shear to 1.5 % and back by {:g} %", 1.5 / quarter),
        [=] { return store.generated(usual, {.friction = 0}); }, shear_and_back(quarter));
  for (const int steps : {10, 20, 40})
    add_spheres(cases, must, "energy", fmt::format("shear to 1 % by {:g} %", 1.0 / steps),
                [=] { return store.generated(usual, {}); },
                {.targets = along(steps, small_shear), .cpu_budget = 60});
}

}  // namespace

void add_sphere_cases(const PackingStore& store, Cases& cases) {
  add_contacts(store, cases);
  add_large([store] { return store.generated(usual, {}); }, cases);
  add_turns(store, cases);
  add_contacts_that_come_and_go(store, cases);
  add_lattice(store, cases);
  add_energy(store, cases);
}

}  // namespace verification::stability

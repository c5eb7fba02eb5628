// Extreme contacts: stiff, soft, slippery, rough, and discs of very different sizes.

#include "evidence/studies/stability/cases.hpp"
#include "evidence/studies/stability/paths.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification::stability {
namespace {

// What the solver is tuned for: Pi = strain increment kn / (p t).
constexpr double moderate_pi = 0.3;

Path shear_and_back() {
  return {.targets = cycles(1, 15, [](double s) { return simple_shear(0.015 * s); })};
}

// Small enough steps for any stiffness, and the same strain for all.
void add_stiffness(const PackingStore& store, Cases& cases) {
  for (int decade = 1; decade <= 7; ++decade) {
    const Recipe recipe{.stiffness = std::pow(10.0, decade)};
    const auto material = [=] { return store.generated(recipe, {}); };
    const double small = moderate_pi / recipe.stiffness;
    add(cases, "kn/p", fmt::format("1e{}, isochoric, 40 increments of Pi = 0.3", decade), material,
        {.targets = along(40, [=](double s) { return isochoric(40 * small * s); })});
    add(cases, "kn/p", fmt::format("1e{}, isochoric, 20 increments of 0.1 %", decade), material,
        {.targets = along(20, [](double s) { return isochoric(0.02 * s); })});
  }
}

void add_friction(const PackingStore& store, Cases& cases) {
  for (const double friction : {0.0, 0.1, 0.5, 1.5, 1e3})
    add(
        cases, "friction", fmt::format("{:g}, shear to 1.5 % and back, 0.1 %", friction),
        [=] { return store.generated({}, {.friction = friction}); }, shear_and_back());
  for (const double ratio : {0.0, 0.2, 0.8, 1.0, 2.0})
    add(
        cases, "kt/kn", fmt::format("{:g}, shear to 1.5 % and back, 0.1 %", ratio),
        [=] { return store.generated({}, {.ratio = ratio}); }, shear_and_back());
  add(
      cases, "rotation", "locked, shear to 1.5 % and back, 0.1 %",
      [=] { return store.generated({}, {.rotation = false}); }, shear_and_back());
}

void add_sizes(const PackingStore& store, Cases& cases) {
  for (const double ratio : {1.0, 2.0, 5.0, 10.0})
    add(
        cases, "size ratio", fmt::format("{:g}, shear to 1.5 % and back, 0.1 %", ratio),
        [=] { return store.generated({.size_ratio = ratio}, {}); }, shear_and_back());
}

void add_sweep(const PackingStore& store, Cases& cases) {
  for (int decade = 2; decade <= 6; ++decade)
    for (const double friction : {0.0, 0.2, 0.5, 0.8}) {
      const Recipe recipe{.stiffness = std::pow(10.0, decade)};
      const double small = moderate_pi / recipe.stiffness;
      // Shear first, since it mobilises friction, then the way back.
      const auto targets = cycles(1, 15, [=](double s) { return isochoric(15 * small * s); });
      add(cases, "sweep", fmt::format("kn/p 1e{}, friction {:g}, Pi = 0.3", decade, friction),
          [=] { return store.generated(recipe, {.friction = friction}); }, {.targets = targets});
    }
}

}  // namespace

void add_contact_cases(const PackingStore& store, Cases& cases) {
  add_stiffness(store, cases);
  add_friction(store, cases);
  add_sizes(store, cases);
  add_sweep(store, cases);
}

}  // namespace verification::stability

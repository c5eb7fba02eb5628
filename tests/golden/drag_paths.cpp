// Discs and spheres with drag: monotone, reversed, held, in parts and in uneven steps; and with inertia.
#include "path.hpp"

namespace grainlaw::golden {
namespace {

const std::string drag = solver("viscous_number = 1e-3");
const std::string timed_drag = solver("viscous_number = 1e-3\nviscous_rate = 2e-3");
const std::string sand_of_spheres = R"(
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5
)";

Tensor compressed(std::size_t dimension, double strain) {
  if (dimension == 2) return {1 + 0.3 * strain, 0.1 * strain, 0, 1 - strain};
  return {1 + 0.4 * strain, 0.1 * strain, 0, 0, 1 + 0.4 * strain, 0, 0, 0, 1 - strain};
}

Lead through(std::size_t dimension, std::vector<double> strains) {
  return [dimension, strains = std::move(strains)](Path& path) {
    for (const double strain : strains) path.go_to(compressed(dimension, strain));
  };
}

const std::vector<double> monotone = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3};
const std::vector<double> reversed = {1e-3, 2e-3, 1e-3, 0, -1e-3, 0, 1e-3};
const std::vector<double> held = {2e-3, 2e-3, 2e-3, 2e-3, 3e-3};

// A step, a hundredth of one, a step again; tried, taken back, and cut.
Lead uneven(std::size_t dimension) {
  return [dimension](Path& path) {
    double last = 0;
    for (const double strain : {1e-3, 1.01e-3, 2e-3, 2.1e-3, 3e-3}) {
      path.set_time_step(0.5 * (strain - last) / 1e-3);
      path.try_out(compressed(dimension, strain + 1e-4));
      path.revert();
      path.go_to(compressed(dimension, strain));
      last = strain;
    }
    path.set_time_step(5);
    path.go_to(compressed(dimension, last));
  };
}

void turned(Path& path) {
  path.go_to({1.001, 0, 0, 0.998});
  path.go_to({0.8, -0.6, 0.6, 0.8});
  path.go_to({0.7984, -0.599, 0.602, 0.798});
}

// Squeezed fast, then held in steps that resolve the motion and in one that ends it.
Lead hit(std::size_t dimension) {
  return [dimension](Path& path) {
    path.set_time_step(2e-5);
    for (const double strain : {3e-4, 6e-4, 9e-4, 9e-4, 9e-4}) {
      path.go_to(compressed(dimension, strain));
    }
    path.set_time_step(1e-2);
    path.go_to(compressed(dimension, 9e-4));
  };
}

void spread_and_closed(Path& path) {
  for (const double a : {1.001, 1.01, 1.02, 1.0, 0.999}) path.go_to({a, 0, 0, a});
}

}  // namespace

void lead_drag_paths(const On& on) {
  on("drag/discs", made_discs + sand + drag, through(2, monotone));
  on("drag/discs/reversed", made_discs + sand + drag, through(2, reversed));
  on("drag/discs/held", made_discs + sand + drag, through(2, held));
  on("drag/discs/parts", made_discs + sand + solver("viscous_number = 1e-3\nviscous_steps = 4"),
     through(2, reversed));
  on("drag/discs/uneven", made_discs + sand + timed_drag, uneven(2));
  on("drag/discs/trial", made_discs + sand + solver("viscous_number = 1e-3\nstart = \"trial\""),
     uneven(2));
  on("drag/discs/coarse", made_discs + sand + solver("viscous_number = 1e-4"),
     through(2, reversed));
  on("drag/discs/turned", made_discs + sand + drag, turned);
  on("drag/discs/lost_and_found",
     made_discs + sand + solver("viscous_number = 1e-3\ncontacts_lost = \"stress_free\""),
     spread_and_closed);
  on("drag/discs/locked", made_discs + sand + "rotation = false\n" + drag, through(2, reversed));
  on("drag/discs/rolling", made_discs + sand + "rolling = { ratio = 0.5, friction = 0.1 }\n" + drag,
     through(2, reversed));
  on("drag/discs/hertz",
     made_discs +
         "[contact]\nlaw = \"hertz\"\nshear_modulus = 29e9\npoisson = 0.2\nfriction = "
         "0.5\n" +
         drag,
     through(2, {1e-4, 2e-4, 1e-4}));
  on("drag/discs/bonded",
     made_discs +
         "[contact]\nlaw = \"bonded\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\n"
         "bond = { normal_strength = 400, tangential_strength = 400, bending_stiffness = 200, "
         "bending_strength = 2 }\n" +
         drag,
     through(2, {2e-3, 4e-3, 6e-3, 8e-3}));
  on("drag/discs/frame", made_discs + sand + "[boundary]\ntype = \"frame-p\"\n" + drag,
     through(2, reversed));
  on("drag/spheres", made_spheres + sand_of_spheres + drag, through(3, monotone));
  on("drag/spheres/reversed", made_spheres + sand_of_spheres + drag, through(3, reversed));
  on("drag/spheres/held", made_spheres + sand_of_spheres + drag, through(3, held));
  on("drag/spheres/parts",
     made_spheres + sand_of_spheres + solver("viscous_number = 1e-3\nviscous_steps = 3"),
     through(3, reversed));
  on("drag/spheres/uneven", made_spheres + sand_of_spheres + timed_drag, uneven(3));
  on("drag/spheres/rolling", made_spheres + rolling_sand_of_spheres + drag, through(3, reversed));
  on("inertia/discs", made_discs + sand + solver("inertia = true"), hit(2));
  on("inertia/discs/frame",
     made_discs + sand + "[boundary]\ntype = \"frame-p\"\n" + solver("inertia = true"), hit(2));
  on("inertia/spheres", made_spheres + sand_of_spheres + solver("inertia = true"), hit(3));
}

}  // namespace grainlaw::golden

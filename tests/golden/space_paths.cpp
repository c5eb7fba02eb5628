// Spheres in equilibrium: laws, cut steps, few and many.
#include "path.hpp"

#include <cmath>

namespace grainlaw::golden {

const std::string made_spheres = R"(
dimension = 3
[packing]
generator = "compaction"
count = 60
radii = [0.004, 0.008]
seed = 2
pressure = 1e5
friction = 0.2
)";
const std::string rolling_sand_of_spheres = R"(
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5
rolling = { ratio = 0.5, friction = 0.1, twisting_ratio = 0.4, twisting_friction = 0.05 }
)";

namespace {

// Some of them have two contacts, between which they may roll about the chord.
const std::string smooth_spheres = R"(
dimension = 3
[packing]
generator = "compaction"
count = 100
radii = [0.001, 0.001]
seed = 1
pressure = 1e5
)";
// Enough for iterative solvers instead of factors.
const std::string many_spheres = R"(
dimension = 3
[packing]
generator = "compaction"
count = 300
radii = [0.004, 0.008]
seed = 5
pressure = 1e5
)";
const std::string spheres_of_files = R"(
dimension = 3
[packing]
particles = "spheres500_particles.csv"
contacts = "spheres500_contacts.csv"
cell = "spheres500_cell.csv"
)";
const std::string sand_of_spheres = R"(
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5
)";
const std::string hertz = R"(
[contact]
law = "hertz"
shear_modulus = 29e9
poisson = 0.2
friction = 0.5
)";
const std::string bonded = R"(
[contact]
law = "bonded"
young = 1e8
ratio = 0.8
friction = 0.5
bond = { normal_strength = 20, tangential_strength = 20, bending_stiffness = 2, bending_strength = 0.05, torsion_stiffness = 1, torsion_strength = 0.05 }
)";

// Shortens in z by so much a step, widens across by a share of it, and shears a little.
void triaxial(Path& path, int steps, double by, double share = 0.4) {
  for (int k = 1; k <= steps; ++k) {
    const double e = by * k;
    path.go_to({1 + share * e, 0.1 * e, 0, 0, 1 + share * e, 0, 0, 0, 1 - e});
  }
}

void shear(Path& path, int steps, double by) {
  for (int k = 1; k <= steps; ++k) path.go_to({1, 0, by * k, 0, 1, 0, 0, 0, 1});
}

void isochoric_cycle(Path& path, int quarter, double amplitude) {
  for (int k = 1; k <= 4 * quarter; ++k) {
    const int in_turn = k <= quarter ? k : k <= 3 * quarter ? 2 * quarter - k : k - 4 * quarter;
    const double a = amplitude * in_turn / quarter;
    path.go_to({std::exp(a / 2), 0, 0, 0, std::exp(a / 2), 0, 0, 0, std::exp(-a)});
  }
}

// A step too large, taken back, and taken in parts; from a trial again, with a rotation, and with
// other tangents.
void cut_steps(Path& path) {
  path.try_out({1.002, 0, 0, 0, 1.002, 0, 0, 0, 0.99});
  path.revert();
  path.go_to({1.001, 0, 0, 0, 1.001, 0, 0, 0, 0.995});
  path.try_out({1.001, 1e-3, 0, 0, 1.001, 0, 0, 0, 0.9945});
  path.try_out({1.001, 1.1e-3, 0, 0, 1.001, 0, 0, 0, 0.9945});
  path.go_to({1.001, 1.1e-3, 0, 2e-4, 1.001, 0, 0, 1e-4, 0.9944}, GRAINLAW_WANT_TANGENT_ELASTIC);
  path.go_to({1.001, 1.2e-3, 0, 2e-4, 1.001, 0, 0, 1e-4, 0.9943}, GRAINLAW_WANT_TANGENT_PERTURBED);
  path.go_to({0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 0.994});
  path.try_out({1.6, 0, 0, 0, 1, 0, 0, 0, 1});
}

}  // namespace

void lead_space_paths(const On& on) {
  on("spheres/frictional/triaxial", made_spheres + sand_of_spheres,
     [](Path& p) { triaxial(p, 6, 1e-3); });
  on("spheres/frictional/shear", made_spheres + sand_of_spheres,
     [](Path& p) { shear(p, 12, 5e-3); });
  on("spheres/frictional/cycle", made_spheres + sand_of_spheres,
     [](Path& p) { isochoric_cycle(p, 2, 1e-3); });
  on("spheres/frictional/cut", made_spheres + sand_of_spheres, cut_steps);
  on("spheres/frictional/trial", made_spheres + sand_of_spheres + solver("start = \"trial\""),
     cut_steps);
  on("spheres/frictional/parts", made_spheres + sand_of_spheres + solver("increment_limit = 0.2"),
     [](Path& p) { triaxial(p, 3, 1e-3); });
  on("spheres/frictional/loose", made_spheres + sand_of_spheres + solver("loose_tolerance = 1e-3"),
     [](Path& p) { triaxial(p, 3, 3e-3); });
  on("spheres/frictional/advancing",
     made_spheres + sand_of_spheres + solver("method = \"advancing\""),
     [](Path& p) { triaxial(p, 1, 1e-3); });
  on("spheres/frictional/lost_and_found",
     made_spheres + sand_of_spheres + solver("contacts_lost = \"stress_free\""), [](Path& p) {
       for (const double a : {1.001, 1.01, 1.005, 1.0, 0.999}) p.go_to({a, 0, 0, 0, a, 0, 0, 0, a});
     });
  on("spheres/two_contacts", smooth_spheres + sand_of_spheres + solver("tolerance = 1e-11"),
     [](Path& p) { triaxial(p, 8, 1e-3); });
  on("spheres/two_contacts/parts",
     smooth_spheres + sand_of_spheres + solver("tolerance = 1e-11\nincrement_limit = 0.5"),
     [](Path& p) { triaxial(p, 3, 2e-3); });
  on("spheres/locked", made_spheres + sand_of_spheres + "rotation = false\n",
     [](Path& p) { triaxial(p, 4, 1e-3); });
  on("spheres/rolling", made_spheres + rolling_sand_of_spheres,
     [](Path& p) { triaxial(p, 5, 1e-3); });
  on("spheres/rolling/cycle", made_spheres + rolling_sand_of_spheres,
     [](Path& p) { isochoric_cycle(p, 2, 1e-3); });
  on("spheres/compressive", made_spheres + "[contact]\nlaw = \"compressive\"\nyoung = 1e8\n",
     [](Path& p) { triaxial(p, 3, 1e-3); });
  on("spheres/hertz", made_spheres + hertz, [](Path& p) { triaxial(p, 4, 1e-4); });
  on("spheres/hertz/cycle",
     made_spheres + hertz +
         "rolling = { ratio = 0.5, friction = 0.1, twisting_ratio = 0.4, twisting_friction = 0.1 "
         "}\n",
     [](Path& p) { isochoric_cycle(p, 2, 1e-4); });
  on("spheres/bonded", made_spheres + bonded, [](Path& p) { triaxial(p, 8, 1e-3, 0.8); });
  on("spheres/bonded/springs",
     made_spheres +
         "[contact]\nlaw = \"bonded\"\nyoung = 1e8\nratio = 0.8\nfriction = 0.5\n"
         "bond = { normal_strength = 20, tangential_strength = 20, normal_stiffness = 7e5, "
         "tangential_stiffness = 3e5 }\n",
     [](Path& p) { triaxial(p, 4, 1e-3, 0.8); });
  on("spheres/bonded/locked",
     made_spheres +
         "[contact]\nlaw = \"bonded\"\nyoung = 1e8\nratio = 0.8\nfriction = 0.5\nrotation = false\n"
         "bond = { normal_strength = 20, tangential_strength = 20 }\n",
     [](Path& p) { triaxial(p, 4, 1e-3, 0.8); });
  on("spheres/growth",
     "dimension = 3\n[packing]\ngenerator = \"lubachevsky-stillinger\"\ncount = 60\n"
     "radii = [0.004, 0.006]\nseed = 5\nvoid_ratio = 0.55\n" +
         sand_of_spheres,
     [](Path& p) { triaxial(p, 3, 1e-3); });
  on("spheres/many", many_spheres + sand_of_spheres, [](Path& p) { triaxial(p, 3, 1e-3); });
  on("spheres/files", spheres_of_files + sand_of_spheres, [](Path& p) { triaxial(p, 2, 1e-3); });
}

}  // namespace grainlaw::golden

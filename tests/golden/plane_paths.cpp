// Discs in equilibrium: laws, boundaries, cut steps.
#include "path.hpp"

#include <cmath>

namespace grainlaw::golden {

const std::string made_discs = R"(
dimension = 2
thickness = 0.1
[packing]
generator = "compaction"
count = 80
radii = [0.004, 0.008]
seed = 3
pressure = 1e5
friction = 0.2
)";
const std::string sand = R"(
[contact]
law = "frictional"
young = 6e8
ratio = 0.8
friction = 0.5
)";

namespace {

const std::string drained_packing = R"(
dimension = 2
[packing]
particles = "rve400_particles.csv"
contacts = "rve400_contacts.csv"
cell = "rve400_cell.csv"
)";
// Held by large overlaps, so that discs of a frame under uniform stress keep their contacts.
const std::string firm_packing = R"(
dimension = 2
thickness = 0.1
[packing]
generator = "compaction"
count = 60
radii = [0.004, 0.006]
seed = 4
pressure = 4e6
)";
const std::string firm_bonds =
    "bond = { normal_strength = 400, tangential_strength = 400, bending_stiffness = 200, "
    "bending_strength = 2 }\n";

std::string boundary(const std::string& keys) { return "[boundary]\n" + keys + "\n"; }

const std::string layer =
    "type = \"mixed\"\n"
    "left = { x = \"P\", y = \"P\", rotation = \"periodic\" }\n"
    "right = { x = \"P\", y = \"P\", rotation = \"periodic\" }\n"
    "bottom = { x = \"D\", y = \"D\", rotation = \"fixed\" }\n"
    "top = { x = \"D\", y = \"T\", rotation = \"free\" }\n";

// Shortens in y by so much a step, and widens in x by a share of it.
void biaxial(Path& path, int steps, double by, double share = 0.3) {
  for (int k = 1; k <= steps; ++k) path.go_to({1 + share * by * k, 0, 0, 1 - by * k});
}

void shear(Path& path, int steps, double by) {
  for (int k = 1; k <= steps; ++k) path.go_to({1, by * k, 0, 1});
}

void isochoric_cycle(Path& path, int quarter, double amplitude) {
  for (int k = 1; k <= 4 * quarter; ++k) {
    const int in_turn = k <= quarter ? k : k <= 3 * quarter ? 2 * quarter - k : k - 4 * quarter;
    const double a = amplitude * in_turn / quarter;
    path.go_to({std::exp(a), 0, 0, std::exp(-a)});
  }
}

// A step too large, taken back, and taken in parts; from a trial again, and with other tangents.
void cut_steps(Path& path) {
  path.try_out({1.002, 0, 0, 0.99});
  path.revert();
  path.go_to({1.001, 0, 0, 0.995});
  path.try_out({1.0015, 1e-3, 0, 0.9945});
  path.try_out({1.0015, 1.1e-3, 0, 0.9945});
  path.go_to({1.0015, 1.1e-3, 2e-4, 0.9944}, GRAINLAW_WANT_TANGENT_ELASTIC);
  path.go_to({1.0016, 1.2e-3, 2e-4, 0.9943}, GRAINLAW_WANT_TANGENT_PERTURBED);
  path.try_out({1.6, 0, 0, 1});
  path.go_to({1.0016, 0.4, -0.3, 0.9943});
}

}  // namespace

void lead_plane_paths(const On& on) {
  const std::string locked = sand + "rotation = false\n";
  const std::string rolling = sand + "rolling = { ratio = 0.5, friction = 0.1 }\n";
  const std::string compressive = "[contact]\nlaw = \"compressive\"\nyoung = 6e8\n";
  const std::string hertz =
      "[contact]\nlaw = \"hertz\"\nshear_modulus = 29e9\npoisson = 0.2\nfriction = 0.5\n";
  const std::string bonded =
      "[contact]\nlaw = \"bonded\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\n" + firm_bonds;

  on("cell/frictional/biaxial", drained_packing + sand, [](Path& p) { biaxial(p, 8, 1e-3); });
  on("cell/frictional/shear", made_discs + sand, [](Path& p) { shear(p, 50, 1e-2); });
  on("cell/frictional/cycle", made_discs + sand, [](Path& p) { isochoric_cycle(p, 3, 2e-3); });
  on("cell/frictional/cut", drained_packing + sand, cut_steps);
  on("cell/frictional/trial", drained_packing + sand + solver("start = \"trial\""), cut_steps);
  on("cell/frictional/loose", made_discs + sand + solver("loose_tolerance = 1e-3"),
     [](Path& p) { biaxial(p, 4, 3e-3); });
  on("cell/frictional/advancing", made_discs + sand + solver("method = \"advancing\""),
     [](Path& p) { biaxial(p, 2, 1e-3); });
  on("cell/frictional/published",
     made_discs + sand + solver("method = \"published\"\ntolerance = 1e-4"),
     [](Path& p) { biaxial(p, 1, 1e-3); });
  on("cell/frictional/lost_and_found",
     made_discs + sand + solver("contacts_lost = \"stress_free\""), [](Path& p) {
       for (const double a : {1.001, 1.01, 1.02, 1.005, 1.0, 0.999}) p.go_to({a, 0, 0, a});
     });
  on("cell/locked", made_discs + locked, [](Path& p) { biaxial(p, 5, 2e-3); });
  on("cell/rolling", made_discs + rolling, [](Path& p) { biaxial(p, 5, 2e-3); });
  on("cell/compressive", made_discs + compressive, [](Path& p) { biaxial(p, 4, 1e-3); });
  on("cell/hertz", made_discs + hertz, [](Path& p) { biaxial(p, 5, 1e-4); });
  on("cell/hertz/cycle", made_discs + hertz + "rolling = { ratio = 0.5, friction = 0.1 }\n",
     [](Path& p) { isochoric_cycle(p, 2, 2e-4); });
  on("cell/hertz/locked", made_discs + hertz + "rotation = false\n",
     [](Path& p) { biaxial(p, 3, 1e-4); });
  on("cell/bonded", made_discs + bonded, [](Path& p) { biaxial(p, 8, 1e-3, 1.0); });
  on("cell/bonded/springs",
     made_discs +
         "[contact]\nlaw = \"bonded\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\n"
         "bond = { normal_strength = 400, tangential_strength = 400, normal_stiffness = 4e6, "
         "tangential_stiffness = 1.5e6 }\n",
     [](Path& p) { biaxial(p, 4, 1e-3, 1.0); });
  on("cell/bonded/locked",
     made_discs +
         "[contact]\nlaw = \"bonded\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\nrotation = false\n"
         "bond = { normal_strength = 400, tangential_strength = 400 }\n",
     [](Path& p) { biaxial(p, 4, 1e-3, 1.0); });
  on("cell/growth",
     "dimension = 2\nthickness = 0.1\n[packing]\ngenerator = \"lubachevsky-stillinger\"\ncount = "
     "60\n"
     "radii = [0.004, 0.006]\nseed = 5\nvoid_ratio = 0.15\n" +
         sand,
     [](Path& p) { biaxial(p, 3, 1e-3); });
  on("frame-d", made_discs + sand + boundary("type = \"frame-d\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-p", made_discs + sand + boundary("type = \"frame-p\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-p/bonded", made_discs + bonded + boundary("type = \"frame-p\""),
     [](Path& p) { biaxial(p, 3, 1e-3, 1.0); });
  on("frame-p/locked_inside",
     made_discs + sand + boundary("type = \"frame-p\"\ninner_rotation = \"fixed\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-t", firm_packing + sand + boundary("type = \"frame-t\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-p/servo",
     firm_packing + sand + boundary("type = \"frame-p\"\nmethod = \"servo\"") +
         solver("tolerance = 1e-3"),
     [](Path& p) { biaxial(p, 1, 1e-4); });
  on("mixed/layer", firm_packing + sand + boundary(layer), [](Path& p) { shear(p, 4, 1e-3); });
  on("mixed/layer/stress", firm_packing + sand + boundary(layer + "stress = { P22 = -1e5 }"),
     [](Path& p) { shear(p, 4, 1e-3); });
}

}  // namespace grainlaw::golden

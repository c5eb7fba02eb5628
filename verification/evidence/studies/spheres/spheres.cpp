// `grainlaw_evidence spheres`: how exact the tangents of spheres are, and what an increment costs over its error
// and over their number, at equilibrium and without jumps (solver.viscous_number).

#include "evidence/studies/spheres/spheres.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace verification {
namespace spheres {
namespace {

constexpr double lateral_share = 0.4;  // of the axial strain, near constant stress before the peak

}  // namespace

grainlaw::Material packed(int count, double viscous_number, double tolerance, int seed) {
  return grainlaw::Material::parse(fmt::format(R"(dimension = 3
[packing]
generator = "compaction"
count = {}
radii = [3e-3, 6e-3]
seed = {}
pressure = 1e5
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5463
[solver]
tolerance = {}
viscous_number = {}
)",
                                               count, seed, tolerance, viscous_number),
                                   ".");
}

// After so many increments of triaxial compression, or of simple shear.
Tensor3 deformation_after(double increments, bool shear) {
  const double strain = increment * increments;
  if (shear) return {1, 0, strain, 0, 1, 0, 0, 0, 1};
  const double lateral = 1 + lateral_share * strain;
  return {lateral, 0, 0, 0, lateral, 0, 0, 0, 1 - strain};
}

}  // namespace spheres

void add_spheres_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    std::vector<int> counts{200, 500, 1000, 2000, 4000};
    int increments = 10;
    int states = 20;
    std::string only;
    double yade_step = 900;  // of a Zen 3 without AVX-512
    int finer = 30;
    int seed = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("spheres", "CPU time over the number of spheres, exact tangents");
  command->add_option("--counts", arguments->counts, "spheres, ascending")->capture_default_str();
  command->add_option("--increments", arguments->increments, "of 0.1 % each")
      ->capture_default_str();
  command->add_option("--states", arguments->states, "tangents of each path")
      ->capture_default_str();
  command->add_option("--only", arguments->only, "one part of it")
      ->check(CLI::IsMember({"tangents", "error", "cost"}));
  command
      ->add_option(
          "--yade-step", arguments->yade_step,
          "CPU time of a step of YADE on this machine, per sphere [ns]; the default is of a "
          "Zen 3")
      ->capture_default_str();
  command
      ->add_option(
          "--finer", arguments->finer,
          "parts of an increment on the path that errors are also measured against; 0: not")
      ->capture_default_str();
  command
      ->add_option("--seed", arguments->seed,
                   "errors of 500 spheres compacted here with this seed; 0: of YADE's")
      ->capture_default_str();
  command->callback([arguments, options] {
    const auto wanted = [&](std::string_view part) {
      return arguments->only.empty() || arguments->only == part;
    };
    if (wanted("tangents")) spheres::check_tangents(*options, arguments->states);
    if (wanted("error")) {
      spheres::measure_error(*options, arguments->seed, arguments->yade_step, arguments->finer);
    }
    if (wanted("cost")) {
      spheres::measure_cost(*options, arguments->counts, arguments->increments);
    }
  });
}

}  // namespace verification

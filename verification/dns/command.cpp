// `grainlaw dns SCENE.toml`: direct simulation of a specimen of repeated frames.

#include "app/bounds.hpp"
#include "app/commands.hpp"
#include "app/jobs.hpp"
#include "app/output.hpp"
#include "dns/run.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace verification {
namespace {

// False when the path ended early and must not.
bool run_one(const SpecimenScene& scene, const std::string& directory) {
  const auto stem = output_stem(directory, scene.name);
  const SpecimenEnd end = run_specimen(scene, stem);
  const Effort& effort = end.effort;
  const bool early = end.steps < end.steps_wanted;
  fmt::print(
      "{}: {} particles, {} of them on the boundary; {} of {} steps, {} evaluations, {} cuts, {} "
      "relaxation steps, {} factorisations, {} with advanced history; {:.2f} s of CPU, {:.2f} s "
      "elapsed{}\nwrote {}.csv, .svg, .png, _cost.csv and the specimen\n",
      scene.name, end.particles, end.boundary, end.steps, end.steps_wanted, effort.evaluations,
      effort.cuts, effort.relaxation_steps, effort.factorisations, effort.history_advanced, end.cpu,
      end.elapsed, early ? "\n  ended: " + end.text : "", stem.string());
  return !early || scene.may_end;
}

void run_dns(const std::string& path, const std::string& directory, int jobs) {
  const std::vector<SpecimenScene> scenes = read_specimen_scenes(SceneFile(path));
  run_jobs(scenes.size(), jobs, [&](std::size_t k) {
    if (!run_one(scenes[k], directory))
      throw ComputationError(
          fmt::format("{}: {} ended before its last step", path, scenes[k].name));
  });
}

}  // namespace

void add_dns_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("dns",
                         "simulate a specimen of repeated frames directly, particle by "
                         "particle");
  auto scene = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>(".");
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  command->add_option("--output", *output, "directory for the results")->capture_default_str();
  auto jobs = std::make_shared<int>(1);
  command->add_option("--jobs", *jobs, "cases at a time")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([scene, output, jobs] { run_dns(*scene, *output, *jobs); });
}

}  // namespace verification

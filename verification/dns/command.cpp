// `grainlaw dns SCENE.toml`: direct simulation of a specimen of repeated frames.

#include "app/commands.hpp"
#include "app/output.hpp"
#include "dns/run.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace verification {
namespace {

void run_dns(const std::string& path, const std::string& directory) {
  const SceneFile file(path);
  const SpecimenScene scene = read_specimen_scene(file);
  const auto stem = output_stem(directory, scene.name);
  const SpecimenEnd end = run_specimen(scene, stem);
  const Effort& effort = end.effort;
  fmt::print(
      "{}: {} particles, {} of them on the boundary; {} of {} steps, {} evaluations, {} cuts, {} "
      "relaxation steps, {} factorisations, {} with advanced history; {:.2f} s of CPU, {:.2f} s "
      "elapsed\n",
      scene.name, end.particles, end.boundary, end.steps, end.steps_wanted, effort.evaluations,
      effort.cuts, effort.relaxation_steps, effort.factorisations, effort.history_advanced, end.cpu,
      end.elapsed);
  if (end.steps < end.steps_wanted) {
    if (!scene.may_end) throw ComputationError(fmt::format("{}: {}", path, end.text));
    fmt::print("  ended: {}\n", end.text);
  }
  fmt::print("wrote {}.csv, .svg, .png, _cost.csv and the specimen\n", stem.string());
}

}  // namespace

void add_dns_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("dns", "simulate a specimen of repeated frames directly, particle by "
                                "particle");
  auto scene = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>(".");
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  command->add_option("--output", *output, "directory for the results")->capture_default_str();
  command->callback([scene, output] { run_dns(*scene, *output); });
}

}  // namespace verification

// `grainlaw dns SCENE.toml`: direct simulation of a specimen of repeated frames.

#include "app/bounds.hpp"
#include "app/cases.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/jobs.hpp"
#include "app/output.hpp"
#include "dns/run.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace verification {
namespace {

void run_dns(const std::string& path, const Destination& destination, int jobs) {
  const std::vector<SpecimenScene> scenes = read_specimen_scenes(SceneFile(path));
  Outputs outputs;
  std::vector<std::filesystem::path> inputs{path};
  for (const SpecimenScene& scene : scenes) {
    const std::string& name = scene.name;
    outputs.add(name, name, {".csv", "_cost.csv"});
    outputs.add_packing(name, name + "_specimen");
    outputs.add_pictures(name, name);
    if (!scene.pictures.empty()) outputs.add_pictures(name, name + "_packing");
    if (scene.vtk_every > 0) outputs.add_series(name, name + "_", ".vtp");
    for (auto& file : files_of(scene.material)) inputs.push_back(std::move(file));
  }
  outputs.check_apart(path);
  const OwnFiles own = destination.claim(outputs, inputs);
  CaseFailures failures(scenes.size());
  const Interrupt interrupt;
  run_jobs(scenes.size(), jobs, [&](std::size_t k) {
    failures.guard(k, scenes[k].name,
                   [&] { run_specimen(scenes[k], destination.stem(scenes[k].name)); });
  });
  failures.check(path);
}

}  // namespace

void add_dns_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("dns",
                         "simulate a specimen of repeated frames directly, particle by "
                         "particle");
  auto scene = std::make_shared<std::string>();
  auto destination = std::make_shared<Destination>();
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  destination->add_options(*command);
  auto jobs = std::make_shared<int>(1);
  command->add_option("--jobs", *jobs, "cases at a time")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([scene, destination, jobs] { run_dns(*scene, *destination, *jobs); });
}

}  // namespace verification

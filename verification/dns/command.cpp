// `grainlaw dns SCENE.toml`: direct simulation of a specimen of repeated frames.

#include "app/bounds.hpp"
#include "app/cases.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/jobs.hpp"
#include "app/output.hpp"
#include "dns/run.hpp"

#include <memory>
#include <string>
#include <vector>

namespace verification {
namespace {

void run_dns(const std::string& path, const std::string& directory, int jobs) {
  const std::vector<SpecimenScene> scenes = read_specimen_scenes(SceneFile(path));
  std::vector<Output> outputs;
  for (const SpecimenScene& scene : scenes) {
    for (const char* end : {".csv", ".svg", ".png", "_cost.csv"})
      outputs.push_back({scene.name + end, scene.name});
    if (scene.pictures.empty()) continue;
    for (const char* end : {"_packing.svg", "_packing.png"})
      outputs.push_back({scene.name + end, scene.name});
  }
  check_outputs(path, outputs);
  CaseFailures failures(scenes.size());
  const Interrupt interrupt;
  run_jobs(scenes.size(), jobs, [&](std::size_t k) {
    failures.guard(k, scenes[k].name,
                   [&] { run_specimen(scenes[k], output_stem(directory, scenes[k].name)); });
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

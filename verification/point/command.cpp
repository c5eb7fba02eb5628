// `grainlaw point SCENE.toml`: representative volumes along paths of strain and stress.

#include "app/atomic_file.hpp"
#include "app/bounds.hpp"
#include "app/cases.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/jobs.hpp"
#include "app/output.hpp"
#include "app/text.hpp"
#include "point/ensemble.hpp"
#include "point/run.hpp"
#include "point/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

namespace verification {
namespace {

struct PointArguments {
  std::string scene;
  std::string output = ".";
  std::vector<std::string> cases;
  int jobs = 1;
  int steps = 0;
};

// The scene's cases that were asked for, all without a wish. A case with seeds is named without them, too.
std::vector<PointScene> chosen(std::vector<PointScene> scenes, const std::string& prefix,
                               const std::vector<Ensemble>& ensembles,
                               const std::vector<std::string>& wanted) {
  if (wanted.empty()) return scenes;
  std::vector<PointScene> result;
  for (const std::string& name : wanted) {
    const auto ensemble =
        std::find_if(ensembles.begin(), ensembles.end(),
                     [&](const Ensemble& one) { return one.name == prefix + "_" + name; });
    if (ensemble != ensembles.end()) {
      for (const PointScene& scene : scenes)
        if (std::find(ensemble->members.begin(), ensemble->members.end(), scene.name) !=
            ensemble->members.end())
          result.push_back(scene);
      continue;
    }
    const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const PointScene& scene) {
      return scene.name == prefix + "_" + name;
    });
    if (found == scenes.end())
      throw InputError(fmt::format("--case {}: the scene has no such case", name));
    result.push_back(*found);
  }
  return result;
}

void write_ends(const std::vector<PointScene>& scenes, const std::vector<PointEnd>& ends,
                const std::filesystem::path& path) {
  const bool spheres = std::any_of(scenes.begin(), scenes.end(),
                                   [](const PointScene& scene) { return scene.dimension == 3; });
  const int dimension = spheres ? 3 : 2;
  std::string table = "case,particles[-],steps[-],steps_wanted[-],";
  for (int i = 1; i <= dimension; ++i)
    for (int j = 1; j <= dimension; ++j) table += fmt::format("F{}{}[-],", i, j);
  table +=
      "relaxation_steps[-],servo_corrections[-],factorisations[-],evaluations[-],"
      "history_advanced[-],cpu[s],status[-],end\n";
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const PointEnd& end = ends[k];
    table += fmt::format("{},{},{},{},", csv_field(scenes[k].name), end.particles, end.steps,
                         end.steps_wanted);
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j < dimension; ++j) table += fmt::format("{:.9g},", end.deformation(i, j));
    table += fmt::format("{},{},{},{},{},{:.4g},{},{}\n", end.effort.relaxation_steps,
                         end.effort.servo_corrections, end.effort.factorisations,
                         end.effort.evaluations, end.effort.history_advanced, end.cpu,
                         static_cast<int>(end.status), csv_field(end.text));
  }
  write_atomically(path, table);
}

void run_command(const PointArguments& arguments) {
  const SceneFile file(arguments.scene);
  const std::string prefix = file.content["name"].value_or(file.path.stem().string());
  std::vector<PointScene> scenes =
      chosen(read_point_scenes(file), prefix, ensembles_of(file, prefix), arguments.cases);
  for (PointScene& scene : scenes) scene.options.max_steps = arguments.steps;
  std::vector<PointEnd> ends(scenes.size());
  CaseFailures failures(scenes.size());
  const Interrupt interrupt;
  run_jobs(scenes.size(), arguments.jobs, [&](std::size_t k) {
    const std::string text = failures.guard(k, scenes[k].name, [&] {
      run_point(scenes[k], output_stem(arguments.output, scenes[k].name), ends[k]);
    });
    if (!text.empty() && ends[k].text == PointEnd().text) ends[k].text = text;
  });
  if (file.content.contains("case"))
    write_ends(scenes, ends, output_stem(arguments.output, prefix + "_cases.csv"));
  for (const Ensemble& ensemble : ensembles_of(file, prefix)) {
    const auto of_it = std::find_if(scenes.begin(), scenes.end(), [&](const PointScene& scene) {
      return scene.name == ensemble.members.front();
    });
    if (of_it != scenes.end())
      write_ensemble(ensemble, output_stem(arguments.output, ensemble.name).parent_path(),
                     of_it->abscissa, of_it->figure);
  }
  failures.check(arguments.scene);
}

}  // namespace

void add_point_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("point", "lead representative volumes along paths of strain and stress");
  auto arguments = std::make_shared<PointArguments>();
  command->add_option("SCENE", arguments->scene, "scene file (TOML)")->required();
  command->add_option("--output", arguments->output, "directory for the results")
      ->capture_default_str();
  command->add_option("--case", arguments->cases, "only this case of the scene; may be repeated");
  command->add_option("--steps", arguments->steps, "leave every path after so many; 0: none")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--jobs", arguments->jobs, "cases at a time")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([arguments] { run_command(*arguments); });
}

}  // namespace verification

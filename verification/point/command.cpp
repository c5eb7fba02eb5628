// `grainlaw point SCENE.toml`: representative volumes along paths of strain and stress.

#include "app/atomic_file.hpp"
#include "app/bounds.hpp"
#include "app/cases.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/jobs.hpp"
#include "app/output.hpp"
#include "io/csv_records.hpp"
#include "point/ensemble.hpp"
#include "point/figures.hpp"
#include "point/price_of_drag.hpp"
#include "point/run.hpp"
#include "point/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace verification {

using grainlaw::core::csv_record;

namespace {

struct PointArguments {
  std::string scene;
  Destination destination;
  std::vector<std::string> cases;
  int jobs = 1;
  int steps = 0;
  bool against_equilibrium = false;
};

bool has_member(const Ensemble& ensemble, const std::string& name) {
  return std::find(ensemble.members.begin(), ensemble.members.end(), name) !=
         ensemble.members.end();
}

// All that these scenes of the file can write.
Outputs outputs_of(const SceneFile& file, const std::string& prefix,
                   const std::vector<PointScene>& scenes, const std::vector<Ensemble>& ensembles) {
  Outputs outputs;
  for (const PointScene& scene : scenes) {
    const std::string& name = scene.name;
    outputs.add(name, name, {".csv"});
    if (scene.vtk_every > 0) outputs.add_series(name, name + "_", ".vtp");
    if (scene.particle_measures) outputs.add(name, name, {"_particles.csv"});
    if (!scene.pictures.empty()) outputs.add_pictures(name, name + "_packing");
    if (!scene.figure) continue;
    outputs.add_pictures(name, name);
    for (const std::string& figure : scene.figures)
      outputs.add_pictures(name, name + figure_end(figure));
  }
  for (const Ensemble& ensemble : ensembles) {
    const std::string owner = "the ensemble of " + ensemble.name;
    outputs.add(owner, ensemble.name + "_ensemble", {".csv"});
    outputs.add_pictures(owner, ensemble.name + "_ensemble");
  }
  if (file.content.contains("case"))
    outputs.add("the ends of the cases", prefix + "_cases", {".csv"});
  return outputs;
}

std::vector<std::filesystem::path> inputs_of(const SceneFile& file,
                                             const std::vector<PointScene>& scenes) {
  std::vector<std::filesystem::path> inputs{file.path};
  for (const PointScene& scene : scenes)
    for (auto& path : files_of(scene.material)) inputs.push_back(std::move(path));
  return inputs;
}

// Cases as the scene names them.
std::vector<std::string> names_of(const std::vector<PointScene>& scenes,
                                  const std::string& prefix) {
  std::vector<std::string> names;
  for (const PointScene& scene : scenes)
    if (scene.name != prefix) names.push_back(scene.name.substr(prefix.size() + 1));
  if (names.empty()) names.emplace_back("none: it has no cases");
  return names;
}

// Requested cases of the scene, all by default. A case with seeds may be requested without them.
std::vector<PointScene> chosen(std::vector<PointScene> scenes, const std::string& prefix,
                               const std::vector<Ensemble>& ensembles,
                               const std::vector<std::string>& wanted) {
  if (wanted.empty()) return scenes;
  std::vector<PointScene> result;
  const auto add = [&](const PointScene& scene) {  // each case once
    if (std::none_of(result.begin(), result.end(),
                     [&](const PointScene& one) { return one.name == scene.name; }))
      result.push_back(scene);
  };
  for (const std::string& name : wanted) {
    const auto ensemble =
        std::find_if(ensembles.begin(), ensembles.end(),
                     [&](const Ensemble& one) { return one.name == prefix + "_" + name; });
    if (ensemble != ensembles.end()) {
      for (const PointScene& scene : scenes)
        if (has_member(*ensemble, scene.name)) add(scene);
      continue;
    }
    const auto found = std::find_if(scenes.begin(), scenes.end(), [&](const PointScene& scene) {
      return scene.name == prefix + "_" + name;
    });
    if (found == scenes.end())
      throw InputError(fmt::format("--case {}: the scene has no such case, expected one of {}",
                                   name, fmt::join(names_of(scenes, prefix), ", ")));
    add(*found);
  }
  return result;
}

// Adds each scene with drag in equilibrium. Throws InputError where there is none.
std::vector<PointScene> with_equilibrium(std::vector<PointScene> scenes) {
  std::vector<PointScene> result;
  for (const PointScene& scene : scenes)
    if (has_drag(scene.material)) result.push_back(in_equilibrium(scene));
  if (result.empty())
    throw InputError(
        "--against-equilibrium: no case has drag, expected a material with solver.viscous_number");
  result.insert(result.begin(), scenes.begin(), scenes.end());
  return result;
}

void tell_prices(const std::vector<PointScene>& scenes, const std::vector<PointEnd>& ends,
                 const Destination& to) {
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const std::string other = scenes[k].name + "_equilibrium";
    const auto balanced = std::find_if(scenes.begin(), scenes.end(),
                                       [&](const PointScene& one) { return one.name == other; });
    if (balanced == scenes.end() || ends[k].particles == 0) continue;
    if (ends[static_cast<std::size_t>(balanced - scenes.begin())].particles == 0) continue;
    fmt::print("{} {}\n", scenes[k].name,
               price_of_drag(read_csv(to.stem(scenes[k].name + ".csv")),
                             read_csv(to.stem(other + ".csv"))));
  }
}

void write_ends(const std::vector<PointScene>& scenes, const std::vector<PointEnd>& ends,
                const std::filesystem::path& path) {
  const bool spheres = std::any_of(scenes.begin(), scenes.end(),
                                   [](const PointScene& scene) { return scene.dimension == 3; });
  const int dimension = spheres ? 3 : 2;
  std::vector<std::string> row{"case", "particles[-]", "steps[-]", "steps_wanted[-]"};
  for (int i = 1; i <= dimension; ++i)
    for (int j = 1; j <= dimension; ++j) row.push_back(fmt::format("F{}{}[-]", i, j));
  for (const char* name : {"relaxation_steps[-]", "servo_corrections[-]", "factorisations[-]",
                           "evaluations[-]", "history_advanced[-]", "cpu[s]", "status[-]", "end"})
    row.emplace_back(name);
  std::string table = csv_record(row);
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const PointEnd& end = ends[k];
    row = {scenes[k].name};
    const auto add = [&](const auto& value) { row.push_back(fmt::format("{}", value)); };
    add(end.particles);
    add(end.steps);
    add(end.steps_wanted);
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j < dimension; ++j)
        row.push_back(fmt::format("{:.9g}", end.deformation(i, j)));
    add(end.effort.relaxation_steps);
    add(end.effort.servo_corrections);
    add(end.effort.factorisations);
    add(end.effort.evaluations);
    add(end.effort.history_advanced);
    row.push_back(fmt::format("{:.4g}", end.cpu));
    add(static_cast<int>(end.status));
    row.push_back(end.text);
    table += csv_record(row);
  }
  write_atomically(path, table);
}

void run_command(const PointArguments& arguments) {
  const SceneFile file(arguments.scene);
  const std::string prefix = file.content["name"].value_or(file.path.stem().string());
  std::vector<PointScene> scenes = read_point_scenes(file);
  const std::vector<Ensemble> ensembles = ensembles_of(file, prefix);
  outputs_of(file, prefix, scenes, ensembles).check_apart(arguments.scene);
  scenes = chosen(std::move(scenes), prefix, ensembles, arguments.cases);
  if (arguments.against_equilibrium) scenes = with_equilibrium(std::move(scenes));
  const Destination& to = arguments.destination;
  const OwnFiles own =
      to.claim(outputs_of(file, prefix, scenes, ensembles), inputs_of(file, scenes));
  for (PointScene& scene : scenes) scene.options.max_steps = arguments.steps;
  std::vector<PointEnd> ends(scenes.size());
  CaseFailures failures(scenes.size());
  const Interrupt interrupt;
  run_jobs(scenes.size(), arguments.jobs, [&](std::size_t k) {
    const std::string text = failures.guard(
        k, scenes[k].name, [&] { run_point(scenes[k], to.stem(scenes[k].name), ends[k]); });
    if (!text.empty() && ends[k].text == PointEnd().text) ends[k].text = text;
  });
  if (file.content.contains("case")) write_ends(scenes, ends, to.stem(prefix + "_cases.csv"));
  for (Ensemble ensemble : ensembles) {
    const PointScene* of_it = nullptr;
    std::vector<std::string> begun;  // cases with a table of this run
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      if (!has_member(ensemble, scenes[k].name)) continue;
      of_it = &scenes[k];
      if (ends[k].particles > 0) begun.push_back(scenes[k].name);
    }
    if (of_it == nullptr) continue;
    ensemble.members = begun;
    write_ensemble(ensemble, to.directory, of_it->abscissa, of_it->figure);
  }
  tell_prices(scenes, ends, to);
  failures.check(arguments.scene);
}

}  // namespace

void add_point_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("point", "lead representative volumes along paths of strain and stress");
  auto arguments = std::make_shared<PointArguments>();
  command->add_option("SCENE", arguments->scene, "scene file (TOML)")->required();
  arguments->destination.add_options(*command);
  command->add_option("--case", arguments->cases, "only this case of the scene; may be repeated");
  command->add_option("--steps", arguments->steps, "leave every path after so many; 0: none")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_flag("--against-equilibrium", arguments->against_equilibrium,
                    "lead every case with drag in equilibrium too, and tell the difference");
  command->add_option("--jobs", arguments->jobs, "cases at a time")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([arguments] { run_command(*arguments); });
}

}  // namespace verification

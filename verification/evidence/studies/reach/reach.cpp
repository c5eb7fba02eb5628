// `grainlaw_evidence reach`: how every increment of many paths reaches its equilibrium.

#include "evidence/studies/reach/packings.hpp"
#include "evidence/studies/reach/paths.hpp"
#include "evidence/studies/reach/spheres.hpp"
#include "evidence/studies/reach/tables.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/jobs.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <mutex>

namespace verification {
namespace {

using namespace reach;

struct Arguments {
  double tolerance = 1e-8;
  double axial = 0.1;
  double shear = 0.5;
  std::string only = "all";
  int count = 400;
  long seed = 1;
  int threads = 1;
  int repeats = 1;
  bool keep_packings = false;
  SmallIncrements small;
};

// A path that is to be led, how many increments it will have, and in which repeat.
struct Job {
  Path path;
  int repeat = 0;
  int steps = 0;
  std::function<void(Path&, const Observer&)> lead;
};

constexpr double large_increment = 0.001;

// The packing of the scenes.
void add_reference_paths(std::vector<Job>& jobs, const StudyOptions& options,
                         const Arguments& arguments, int repeat) {
  constexpr double stiffness = 300;  // of discs of 5 mm at 100 kPa
  constexpr double friction = 0.5463024898437905;
  const auto material =
      std::make_shared<Material>(make_material(options.material(arguments.tolerance, repeat)));
  const auto steps = [](double strain) { return static_cast<int>(strain / large_increment + 0.5); };
  if (arguments.only != "shear")
    jobs.push_back({{"yade400", "drained", stiffness, friction, {}, "", 1},
                    repeat,
                    steps(arguments.axial),
                    [=, n = steps(arguments.axial)](Path& path, const Observer& observe) {
                      lead_drained(path, *material, arguments.axial, n, observe);
                    }});
  if (arguments.only != "drained")
    jobs.push_back({{"yade400", "shear", stiffness, friction, {}, "", 1},
                    repeat,
                    steps(arguments.shear),
                    [=, n = steps(arguments.shear)](Path& path, const Observer& observe) {
                      lead_shear(path, *material, arguments.shear, n, observe);
                    }});
}

// Both paths of a packing, with this friction in its contacts.
void add_grid_material(std::vector<Job>& jobs, const PackingRecipe& recipe, const std::string& name,
                       double stiffness, double friction, int repeat,
                       const SmallIncrements& limits) {
  const auto material =
      std::make_shared<Material>(read_packing(recipe, name, stiffness, friction, nudged(repeat)));
  const auto add = [&](const char* kind, auto lead) {
    jobs.push_back(
        {{name, kind, stiffness, friction, {}, "", 1},
         repeat,
         limits.steps(stiffness),
         [=](Path& path, const Observer& observe) { lead(path, *material, limits, observe); }});
  };
  add("drained", lead_small_drained);
  add("shear", lead_small_shear);
}

// Packings of five stiffnesses, each with five frictions.
void add_grid_paths(std::vector<Job>& jobs, const StudyOptions& options,
                    const Arguments& arguments) {
  const PackingRecipe recipe{options.scene("pack400.toml"),
                             options.output + "/reach_packings",
                             arguments.count,
                             arguments.seed,
                             arguments.tolerance,
                             arguments.keep_packings};
  for (const double stiffness : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    fmt::print(stderr, "packing of {} discs at kn/p = {:.0e}\n", arguments.count, stiffness);
    const std::string name = make_packing(recipe, stiffness);
    for (int repeat = 0; repeat < arguments.repeats; ++repeat) {
      for (const double friction : {0.0, 0.2, 0.4, 0.6, 0.8})
        add_grid_material(jobs, recipe, name, stiffness, friction, repeat, arguments.small);
    }
  }
}

void add_sphere_paths(std::vector<Job>& jobs, const Arguments& arguments) {
  for (const double stiffness : {1e2, 1e3, 1e4, 1e5}) {
    for (const double friction : {0.2, 0.5, 0.8}) {
      const auto material = std::make_shared<Material>(
          make_spheres(arguments.count, arguments.seed, arguments.tolerance, stiffness, friction));
      for (const char* kind : {"drained", "isochoric", "shear"}) {
        jobs.push_back({{fmt::format("spheres{}_{:.0e}", arguments.count, stiffness),
                         kind,
                         stiffness,
                         friction,
                         {},
                         "",
                         1},
                        0,
                        arguments.small.steps(stiffness),
                        [=](Path& path, const Observer& observe) {
                          lead_spheres(path, *material, arguments.small, observe);
                        }});
      }
    }
  }
}

void lead_all(std::vector<Job>& jobs, int threads) {
  double planned = 0;
  for (const Job& job : jobs) planned += job.steps;
  Progress progress("reach");
  std::mutex showing;
  double done = 0;
  int not_direct = 0;
  run_jobs(jobs.size(), threads, [&](std::size_t k) {
    Job& job = jobs[k];
    job.lead(job.path, [&](const Increment& increment) {
      const std::lock_guard lock(showing);
      not_direct += increment.ending == Ending::direct ? 0 : 1;
      progress.update(++done / planned,
                      fmt::format("{} of {:.0f} increments not direct, {} {}", not_direct, done,
                                  job.path.packing, job.path.kind));
    });
    const std::lock_guard lock(showing);  // increments that a path did not come to are not awaited
    planned -= job.steps - static_cast<double>(job.path.increments.size());
  });
}

void run_study(const StudyOptions& options, const Arguments& arguments) {
  std::vector<Job> jobs;
  const bool spheres = arguments.only == "spheres";
  if (spheres) add_sphere_paths(jobs, arguments);
  for (int repeat = 0; !spheres && arguments.only != "grid" && repeat < arguments.repeats; ++repeat)
    add_reference_paths(jobs, options, arguments, repeat);
  if (arguments.only == "grid" || arguments.only == "all") add_grid_paths(jobs, options, arguments);
  lead_all(jobs, arguments.threads);
  std::vector<std::vector<Path>> repeats(static_cast<std::size_t>(arguments.repeats));
  for (Job& job : jobs)
    repeats[static_cast<std::size_t>(job.repeat)].push_back(std::move(job.path));
  tabulate(repeats[0], arguments.tolerance, options.output);
  if (repeats.size() > 1) tabulate_repeats(repeats, arguments.tolerance, options.output);
}

}  // namespace

void add_reach_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("reach", "how every increment of many paths reaches equilibrium");
  command->add_option("--tolerance", arguments->tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command
      ->add_option("--axial", arguments->axial, "axial strain of the drained path of yade400 [-]")
      ->capture_default_str();
  command->add_option("--shear", arguments->shear, "F12 of the shear path of yade400 [-]")
      ->capture_default_str();
  command
      ->add_option(
          "--only", arguments->only,
          "some of the paths; grid: packings of our own; spheres: the same of spheres, not in all")
      ->check(CLI::IsMember({"all", "drained", "shear", "grid", "spheres"}))
      ->capture_default_str();
  command->add_option("--count", arguments->count, "particles of a packing of the grid [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the packings of the grid [-]")
      ->capture_default_str();
  command->add_option("--increments", arguments->small.most, "of a path of the grid, at most [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command
      ->add_option(
          "--repeats", arguments->repeats,
          "of every path, with stiffnesses apart by 1e-6 of it: what is left to chance [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_flag("--keep-packings", arguments->keep_packings,
                    "take the packings of the grid that an earlier run left in the output");
  command->add_option("--threads", arguments->threads, "paths led at once [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([arguments, options] { run_study(*options, *arguments); });
}

}  // namespace verification

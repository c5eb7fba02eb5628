// `grainlaw_evidence start`: in how many steps of the drained test Newton's method converges, with
// solver.start = "committed" and "trial". With "trial", also how much P depends on the iterates.

#include "evidence/studies/start/newton.hpp"
#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace verification {
namespace {

using namespace start;

constexpr std::array<const char*, 2> starts{"committed", "trial"};
constexpr double bar = 0.99;  // of the steps, with one of the two

struct Arguments {
  double equilibrium = 1e-11;  // tolerance [-]
  int packings = 3;
  bool piola = false;
  NewtonOptions newton;
};

// The value that the share of the values does not exceed.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1;
  return values[static_cast<std::size_t>(std::max(rank, 0.0))];
}

struct Tally {
  double planned = 0;
  double converged = 0;
  double evaluations = 0;
  double cpu = 0;
  std::vector<double> iterations, dependence;

  void add(const Run& run, int steps) {
    planned += steps;  // a path that ends early has not converged in the rest
    for (const start::Step& step : run.steps) {
      evaluations += step.evaluations;
      cpu += step.cpu;
      if (!step.converged) continue;
      converged += 1;
      iterations.push_back(step.iterations);
      if (std::isfinite(step.dependence)) dependence.push_back(step.dependence);
    }
  }
};

void add_row(Table& table, const std::string& start, const std::string& packing,
             const Tally& tally) {
  const double share = tally.converged / tally.planned;
  table.row({start, packing, tally.planned, tally.converged, share, share >= bar ? "yes" : "no",
             median(tally.iterations), quantile(tally.iterations, 0.9), largest(tally.iterations),
             tally.evaluations / tally.planned, tally.cpu / tally.planned, median(tally.dependence),
             quantile(tally.dependence, 0.9), largest(tally.dependence)});
}

void tabulate(const std::vector<Run>& runs, const Arguments& arguments,
              const std::filesystem::path& output) {
  const NewtonOptions& newton = arguments.newton;
  Table table(
      fmt::format("drained test in {} steps to {:g} %, lateral stress to {:.0e} within {} "
                  "iterations, equilibria to {:.0e}; the bar: {:g} % of the steps with one "
                  "of the two; dP: converged P against P of the same F from the committed "
                  "state alone",
                  newton.steps, 100 * newton.axial, newton.tolerance, newton.max_iterations,
                  arguments.equilibrium, 100 * bar),
      {"start", "packing", "steps[-]", "converged[-]", "share[-]", "bar_met",
       "iterations_median[-]", "iterations_90[-]", "iterations_max[-]", "evaluations_per_step[-]",
       "cpu_per_step[ms]", "dP_median[-]", "dP_90[-]", "dP_max[-]"});
  for (const char* kind : starts) {
    Tally all;
    for (const Run& run : runs) {
      if (run.start != kind) continue;
      Tally tally;
      tally.add(run, newton.steps);
      all.add(run, newton.steps);
      add_row(table, run.start, run.packing, tally);
    }
    add_row(table, kind, "all", all);
  }
  table.print();
  table.write(output / "start.csv");

  Table rest(
      "every step that did not converge; gap: between the nearest iterates on either side, "
      "in F11 / axial increment, and in the residual",
      {"start", "packing", "step[-]", "strain[-]", "reason", "iterations[-]", "not_direct[-]",
       "best_residual[-]", "gap_width[-]", "gap_jump[-]", "parts[-]", "loose[-]",
       "evaluations[-]"});
  for (const Run& run : runs)
    for (const start::Step& step : run.steps) {
      if (step.converged) continue;
      const start::Step::Gap gap = step.gap(newton.axial / newton.steps);
      rest.row({run.start, run.packing, static_cast<double>(step.step), step.strain, step.reason,
                static_cast<double>(step.iterations), static_cast<double>(step.not_direct),
                step.best_residual(), gap.width, gap.jump, static_cast<double>(step.parts),
                static_cast<double>(step.loose), static_cast<double>(step.evaluations)});
    }
  rest.print();
  rest.write(output / "start_rest.csv");
  for (const Run& run : runs)
    if (!run.gave_up.empty())
      fmt::print("{}, {} ended early: {}\n", run.start, run.packing, run.gave_up);
}

// The packing of the scenes, then seeds 1, 2, ... of the recipe.
MaterialSource material_source(const StudyOptions& options, const Arguments& arguments, long seed) {
  MaterialSource source = options.material(arguments.equilibrium);
  if (seed == 0) return source;
  source.file = options.scene("pack400.toml");
  change(source, "packing", "seed", seed);
  return source;
}

void run_study(const StudyOptions& options, Arguments arguments) {
  if (arguments.piola) arguments.newton.lateral = Lateral::piola;
  std::vector<Run> runs;
  Progress progress("start");
  const double planned = 2.0 * (arguments.packings + 1) * arguments.newton.steps;
  double done = 0;
  int not_converged = 0;
  for (const char* kind : starts)
    for (long seed = 0; seed <= arguments.packings; ++seed) {
      MaterialSource source = material_source(options, arguments, seed);
      change(source, "solver", "start", std::string(kind));
      Run run{kind, seed == 0 ? "yade400" : fmt::format("pack400_seed{}", seed), {}, ""};
      lead(run, make_material(source), arguments.newton, [&](const start::Step& step) {
        not_converged += step.converged ? 0 : 1;
        progress.update(++done / planned,
                        fmt::format("{} of {:.0f} steps not converged, {} {} at {:.1f} %",
                                    not_converged, done, kind, run.packing, 100 * step.strain));
      });
      runs.push_back(std::move(run));
    }
  tabulate(runs, arguments, options.output);
}

}  // namespace

void add_start_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("start", "convergence of stress control by solver.start");
  command->add_option("--packings", arguments->packings, "seeds of pack400.toml beside yade400 [-]")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--steps", arguments->newton.steps, "to the end of the path [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--axial", arguments->newton.axial, "axial strain at the end [-]")
      ->capture_default_str();
  command->add_option("--iterations", arguments->newton.max_iterations, "of a step, at most [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--residual", arguments->newton.tolerance, "of the lateral stress [-]")
      ->capture_default_str();
  command->add_option("--tolerance", arguments->equilibrium, "of the equilibria [-]")
      ->capture_default_str();
  command->add_flag("--piola", arguments->piola, "keep the lateral P11 instead of sigma11");
  command->callback([arguments, options] { run_study(*options, *arguments); });
}

}  // namespace verification

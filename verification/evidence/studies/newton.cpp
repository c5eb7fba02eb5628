// `grainlaw_evidence newton`: convergence of the finite element Newton method by kind of tangent.

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/progress.hpp"
#include "fe/scene.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>

namespace verification {
namespace {

struct Run {
  std::vector<double> iterations;              // per step
  std::vector<std::vector<double>> residuals;  // per step
  double cuts = 0;
  double evaluations = 0;
};

Run solve_drained(FiniteElementScene scene, const std::string& tangent, int steps,
                  int max_iterations) {
  scene.solver.newton.tangent = tangent_bit(tangent);
  scene.solver.newton.max_iterations = max_iterations;
  Run run;
  Progress progress(tangent + " tangent");
  const Material material = make_material(scene.material);
  try {
    const auto solver = make_solver(scene.solver, scene.model, material, scene.threads);
    run_load_steps(*solver, scene.solver.duration(), scene.steps, steps,
                   [&](const LoadStep& step, const Solver&) {
                     progress.update(static_cast<double>(step.record.step) / steps, "");
                     if (step.record.step == 0) return;
                     run.iterations.push_back(step.record.effort.iterations);
                     run.residuals.push_back(step.residuals);
                     run.cuts += step.record.effort.cuts;
                     run.evaluations += step.record.effort.evaluations;
                   });
  } catch (const ComputationError& error) {
    fmt::print("{} tangent: {}\n", tangent, error.what());
  }
  return run;
}

// Iterations of a residual history that are printed; the table on disk has all.
constexpr std::size_t first_shown = 6;
constexpr std::size_t every_shown = 10;

void run_study(const StudyOptions& options, int steps, int max_iterations) {
  const SceneFile file(options.scene("drained.toml"));
  const FiniteElementScene scene = read_fe_scene(file);
  constexpr std::array<const char*, 2> kinds{"exact", "elastic"};
  std::array<Run, 2> runs;
  for (std::size_t k = 0; k < 2; ++k)
    runs[k] = solve_drained(scene, kinds[k], steps, max_iterations);

  Table table(fmt::format("single element, first {} load steps of 1/{} of the run, to a relative "
                          "residual of {:.0e} [-]",
                          steps, scene.steps, scene.solver.newton.tolerance),
              {"tangent", "steps[-]", "iterations_median[-]", "iterations_max[-]",
               "share_at_most_5[-]", "evaluations_per_step[-]", "step_cuts[-]"});
  for (std::size_t k = 0; k < 2; ++k) {
    double few = 0;
    for (const double count : runs[k].iterations) few += count <= 5 ? 1 : 0;
    const auto done = static_cast<double>(runs[k].iterations.size());
    table.row({kinds[k], done, median(runs[k].iterations), largest(runs[k].iterations), few / done,
               runs[k].evaluations / done, runs[k].cuts});
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_newton.csv");

  std::vector<std::string> columns{"iteration[-]"};
  std::vector<const std::vector<double>*> histories;
  for (const int step : {std::max(1, steps / 3), std::max(1, 2 * steps / 3), steps})
    for (std::size_t k = 0; k < 2; ++k) {
      const auto index = static_cast<std::size_t>(step - 1);
      if (index >= runs[k].residuals.size()) continue;
      columns.push_back(fmt::format("step_{}_{}[-]", step, kinds[k]));
      histories.push_back(&runs[k].residuals[index]);
    }
  Table history("", columns);
  Table shown("relative residual by iteration; 0 is the imbalance after the load increment",
              columns);
  std::size_t length = 0;
  for (const auto* residuals : histories) length = std::max(length, residuals->size());
  for (std::size_t i = 0; i < length; ++i) {
    std::vector<Table::Cell> cells{static_cast<double>(i)};
    for (const auto* residuals : histories)
      cells.push_back(i < residuals->size() ? Table::Cell((*residuals)[i]) : Table::Cell(""));
    history.row(cells);
    if (i <= first_shown || i % every_shown == 0) shown.row(cells);
  }
  shown.print();
  history.write(std::filesystem::path(options.output) / "study_newton_residuals.csv");
}

}  // namespace

void add_newton_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    int steps = 15;
    int max_iterations = 100;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("newton", "finite element iterations with exact and elastic tangent");
  command->add_option("--steps", arguments->steps, "load steps of drained.toml [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--max-iterations", arguments->max_iterations, "before a step is cut [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback(
      [arguments, options] { run_study(*options, arguments->steps, arguments->max_iterations); });
}

}  // namespace verification

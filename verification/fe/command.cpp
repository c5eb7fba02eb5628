// `grainlaw solve SCENE.toml`: finite elements whose integration points are representative volumes.

#include "app/commands.hpp"
#include "app/history.hpp"
#include "app/output.hpp"
#include "app/progress.hpp"
#include "fe/output/energy.hpp"
#include "fe/output/probe.hpp"
#include "fe/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

namespace verification {
namespace {

// What load steps cost: processor time of all threads, waiting ones included, and elapsed time.
class CostMeter {
 public:
  // Step 0 is where the clock starts.
  void add(const LoadStep& step, const PointField& points) {
    const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    const auto now = Clock::now();
    if (step.record.step == 0) {
      cpu_start_ = cpu;
      start_ = now;
      return;
    }
    ++steps_;
    points_ = points.size();
    evaluations_ += step.record.effort.evaluations;
    cpu_ = cpu - cpu_start_;
    elapsed_ = std::chrono::duration<double>(now - start_).count();
  }

  [[nodiscard]] std::string summary() const {
    const double steps = std::max(steps_, 1);
    return fmt::format(
        "{} points: {:.2f} evaluations and {:.2f} core-milliseconds per point and load step; "
        "{:.2f} s elapsed",
        points_, evaluations_ / steps, 1e3 * cpu_ / (steps * static_cast<double>(points_)),
        elapsed_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  int steps_ = 0;
  std::size_t points_ = 1;
  double evaluations_ = 0;                        // per point
  double cpu_start_ = 0, cpu_ = 0, elapsed_ = 0;  // [s]
  Clock::time_point start_;
};

void run_solve(const std::string& path, const std::string& directory) {
  const SceneFile file(path);
  const FiniteElementScene scene = read_fe_scene(file);
  const Material material = make_material(scene.material);
  const auto stem = output_stem(directory, scene.name);
  History history(stem);
  CsvWriter newton(stem.string() + "_newton.csv",
                   {"step[-]", "iteration[-]", "relative_residual[-]"});
  std::vector<std::string> force_columns{"step[-]"};
  for (const PrescribedDisplacement& condition : scene.model.displacements) {
    force_columns.push_back(condition.name + "_displacement[m]");
    force_columns.push_back(condition.name + "_force[N/m]");
  }
  CsvWriter forces(stem.string() + "_force.csv", force_columns);
  ProbeHistory probes(stem, scene.probes);
  EnergyHistory energies(stem);
  Progress progress(scene.name);
  CostMeter cost;
  const auto observe = [&](const LoadStep& step, const Solver& solver) {
    const PointField& points = solver.points();
    const int number = step.record.step;
    cost.add(step, points);
    history.add(step.record);
    probes.add(step, solver.displacement());
    energies.add(step);
    for (std::size_t k = 0; k < step.residuals.size(); ++k)
      newton.row({static_cast<double>(number), static_cast<double>(k), step.residuals[k]});
    std::vector<double> force_row{static_cast<double>(number)};
    for (std::size_t k = 0; k < step.reactions.size(); ++k) {
      force_row.push_back(step.displacements[k]);
      force_row.push_back(step.reactions[k]);
    }
    forces.row(force_row);
    if (scene.vtk_every > 0 && number % scene.vtk_every == 0)
      write_vtk(points.state(0), stem, number);
    progress.update(static_cast<double>(number) / scene.steps,
                    fmt::format("axial strain {:.2f} %, sigma22 {:.1f} kPa",
                                100 * step.record.axial_strain(), step.record.cauchy(1, 1) / 1e3));
  };
  try {
    const auto solver = make_solver(scene.solver, scene.model, material, scene.threads);
    run_load_steps(*solver, scene.solver.duration(), scene.steps, scene.steps, observe);
  } catch (const ComputationError& error) {
    history.draw_figure(scene.abscissa, scene.name);
    throw ComputationError(fmt::format("{}: {}", path, error.what()));
  }
  history.draw_figure(scene.abscissa, scene.name);
  fmt::print("{}: {}\n{}\nwrote {}.csv, _newton.csv, _force.csv, .svg, .png\n", scene.name,
             history.summary(), cost.summary(), stem.string());
}

}  // namespace

void add_solve_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("solve", "solve a finite element scene with a packing in every point");
  auto scene = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>(".");
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  command->add_option("--output", *output, "directory for the results")->capture_default_str();
  command->callback([scene, output] { run_solve(*scene, *output); });
}

}  // namespace verification

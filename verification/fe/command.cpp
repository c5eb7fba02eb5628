// `grainlaw solve SCENE.toml`: finite elements whose integration points are representative volumes.

#include "app/commands.hpp"
#include "app/history.hpp"
#include "app/output.hpp"
#include "app/progress.hpp"
#include "fe/scene.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace verification {
namespace {

void run_solve(const std::string& path, const std::string& directory) {
  const SceneFile file(path);
  const FiniteElementScene scene = read_fe_scene(file);
  const Material material = make_material(scene.material);
  const auto stem = output_stem(directory, scene.name);
  History history(stem);
  CsvWriter newton(stem.string() + "_newton.csv",
                   {"step[-]", "iteration[-]", "relative_residual[-]"});
  Progress progress(scene.name);
  const auto observe = [&](const LoadStep& step, const PointField& points) {
    const int number = step.record.step;
    history.add(step.record);
    for (std::size_t k = 0; k < step.residuals.size(); ++k)
      newton.row({static_cast<double>(number), static_cast<double>(k), step.residuals[k]});
    if (scene.vtk_every > 0 && number % scene.vtk_every == 0)
      write_vtk(points.state(0), stem, number);
    progress.update(static_cast<double>(number) / scene.steps,
                    fmt::format("axial strain {:.2f} %, sigma22 {:.1f} kPa",
                                100 * step.record.axial_strain(), step.record.cauchy(1, 1) / 1e3));
  };
  try {
    run_load_steps(scene.model, material, scene.options, scene.steps, scene.steps, observe);
  } catch (const ComputationError& error) {
    history.draw_figure(scene.abscissa, scene.name);
    throw ComputationError(fmt::format("{}: {}", path, error.what()));
  }
  history.draw_figure(scene.abscissa, scene.name);
  fmt::print("{}: {}\nwrote {}.csv, _newton.csv, .svg, .png\n", scene.name, history.summary(),
             stem.string());
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

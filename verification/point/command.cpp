// `grainlaw point SCENE.toml`: one representative volume along a path of strain and stress.

#include "app/commands.hpp"
#include "app/history.hpp"
#include "app/material.hpp"
#include "app/output.hpp"
#include "app/progress.hpp"
#include "point/driver.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace verification {
namespace {

struct PointScene {
  std::string name;
  MaterialSource material;
  PointOptions options;
  std::vector<Segment> segments;
  std::string abscissa;
  int vtk_every = 0;
};

PointScene read_scene(const SceneFile& file) {
  SceneTable table = file.root();
  PointScene scene;
  scene.name = table.text_or("name", file.path.stem().string());
  scene.material = read_material_source(table);
  scene.options.tangent =
      tangent_bit(table.choice_or("tangent", "exact", {"exact", "elastic", "perturbed"}));
  scene.options.tolerance = table.number_or("tolerance", scene.options.tolerance, positive);
  scene.options.max_iterations =
      table.integer_or("max_iterations", scene.options.max_iterations, 1);
  scene.options.max_cuts = table.integer_or("max_cuts", scene.options.max_cuts, 0);
  scene.options.loose_tolerance = table.number_or("loose_tolerance", 0, not_negative);
  scene.segments = read_segments(table);
  scene.abscissa = table.choice_or("abscissa", axial_abscissa, {axial_abscissa, shear_abscissa});
  scene.vtk_every = table.integer_or("vtk_every", 0, 0);
  table.close();
  return scene;
}

void run_point(const std::string& path, const std::string& directory) {
  const SceneFile file(path);
  const PointScene scene = read_scene(file);
  const Material material = make_material(scene.material);
  const auto stem = output_stem(directory, scene.name);
  History history(stem);
  PointDriver driver(material, scene.options);
  history.add(driver.record());
  if (scene.vtk_every > 0) write_vtk(driver.state(), stem, 0);

  int total = 0;
  for (const Segment& segment : scene.segments) total += segment.steps;
  const auto observe = [&,
                        progress = std::make_shared<Progress>(scene.name)](const PointStep& step) {
    const Record& record = step.record;
    history.add(record);
    if (scene.vtk_every > 0 && record.step % scene.vtk_every == 0)
      write_vtk(step.state, stem, record.step);
    progress->update(
        static_cast<double>(record.step) / total,
        fmt::format("sigma22 {:.1f} kPa, F22 {:.4f}, F12 {:.4f}", record.cauchy(1, 1) / 1e3,
                    record.deformation(1, 1), record.deformation(0, 1)));
  };
  try {
    for (const Segment& segment : scene.segments) driver.run(segment, observe);
  } catch (const ComputationError& error) {
    history.draw_figure(scene.abscissa, scene.name);
    throw ComputationError(fmt::format("{}: {}", path, error.what()));
  }
  history.draw_figure(scene.abscissa, scene.name);
  fmt::print("{}: {}\nwrote {}.csv, .svg, .png\n", scene.name, history.summary(), stem.string());
}

}  // namespace

void add_point_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "point", "lead one representative volume along a path of strain and stress");
  auto scene = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>(".");
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  command->add_option("--output", *output, "directory for the results")->capture_default_str();
  command->callback([scene, output] { run_point(*scene, *output); });
}

}  // namespace verification

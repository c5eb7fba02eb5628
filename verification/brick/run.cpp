#include "brick/run.hpp"

#include "app/history.hpp"
#include "app/interrupt.hpp"
#include "app/load_figure.hpp"
#include "app/output.hpp"
#include "app/progress.hpp"
#include "app/written.hpp"
#include "brick/scene.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <optional>

namespace verification {
namespace {

// Processor time of all threads [s].
double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

void run_brick_scene(const SceneFile& file, const Destination& destination, int stop_after) {
  const BrickScene scene = read_brick_scene(file);
  Outputs outputs;
  outputs.add(scene.name, scene.name, {".csv", "_force.csv"});
  outputs.add_pictures(scene.name, scene.name);
  outputs.add_pictures(scene.name, scene.name + "_force");
  std::vector<std::filesystem::path> inputs = files_of(scene.material);
  inputs.push_back(file.path);
  const OwnFiles own = destination.claim(outputs, inputs);
  const std::filesystem::path stem = destination.stem(scene.name);
  const Material material = make_material(scene.material, 3);
  const Interrupt interrupt;
  const double start = cpu();
  const PackingStart begin = measure_start(State(material).get(), scene.material);
  print_start(scene.name, begin);
  BrickNewton solver(scene.model, material, scene.newton, scene.threads);
  Written written(stem);
  History history(stem, 3, has_drag(scene.material));
  std::vector<std::string> columns = force_columns(scene.model);
  columns.insert(columns.begin(), "step[-]");
  CsvWriter forces(stem.string() + "_force.csv", columns);
  for (const char* end : {".csv", "_force.csv"}) written.add(end);
  std::optional<Progress> progress(scene.name);
  std::exception_ptr stopped;
  std::string end;
  int done = -1;
  const auto fraction = [&] { return static_cast<double>(done) / scene.steps; };
  try {
    while (done < scene.steps && (stop_after < 0 || done < stop_after)) {
      const int number = done + 1;
      const BrickStep step =
          solver.advance(static_cast<double>(number) / scene.steps, number,
                         [&](double part, const std::string& reason) {
                           progress->update(fraction(), describe_cut(number, part, reason));
                           Interrupt::check();
                         });
      done = number;
      history.add(step.record);
      std::vector<double> row = force_values(scene.model, solver.displacement(), solver.residual());
      row.insert(row.begin(), number);
      forces.row(row);
      progress->update(fraction(),
                       fmt::format("axial strain {:.2f} %, sigma33 {:.1f} kPa, {} iterations",
                                   100 * step.record.axial_strain(), step.record.cauchy(2, 2) / 1e3,
                                   step.record.effort.iterations));
      if (done < scene.steps) Interrupt::check();
    }
  } catch (const StepError& error) {
    stopped = std::make_exception_ptr(StepError(
        error.status, error.what() + load_advice(begin, std::max(done, 0), error.status)));
  } catch (const Interrupted& stop) {
    stopped = std::current_exception();
    end = fmt::format("{} after step {} of {}", stop.text(), done, scene.steps);
  }
  if (!stopped && done < scene.steps)
    end = fmt::format("left after step {} of {} as asked", done, scene.steps);
  progress.reset();
  if (done >= 0) {
    written.add_pictures(history.draw_figure(scene.abscissa));
    std::vector<std::string> conditions;
    for (const auto& condition : scene.model.displacements) conditions.push_back(condition.name);
    if (draw_load_figure(read_csv(forces.path()), conditions, "N", stem.string() + "_force"))
      written.add("_force.svg");
  }
  fmt::print("{}: {}; {:.2f} s of CPU{}\n{}\n", scene.name, history.summary(), cpu() - start,
             end.empty() ? "" : "\n  ended: " + end, written.text());
  if (stopped) std::rethrow_exception(stopped);
}

}  // namespace verification

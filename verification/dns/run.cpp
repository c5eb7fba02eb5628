#include "dns/run.hpp"

#include "app/history.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/snapshot.hpp"
#include "app/state_files.hpp"
#include "app/written.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <exception>
#include <optional>

namespace verification {
namespace {

// Axial strain since the start, compression positive.
double axial_strain(const Record& record, const Record& start) {
  return 1 - record.deformation(1, 1) / start.deformation(1, 1);
}

void write_cost(const SpecimenEnd& end, const std::filesystem::path& path) {
  const Effort& effort = end.effort;
  write_csv(path,
            {"particles[-]", "boundary[-]", "steps[-]", "steps_wanted[-]", "evaluations[-]",
             "relaxation_steps[-]", "factorisations[-]", "cuts[-]", "history_advanced[-]", "cpu[s]",
             "elapsed[s]"},
            {{static_cast<double>(end.particles), static_cast<double>(end.boundary),
              static_cast<double>(end.steps), static_cast<double>(end.steps_wanted),
              static_cast<double>(effort.evaluations), static_cast<double>(effort.relaxation_steps),
              static_cast<double>(effort.factorisations), static_cast<double>(effort.cuts),
              static_cast<double>(effort.history_advanced), end.cpu, end.elapsed}});
}

std::string description(const SpecimenEnd& end) {
  const Effort& effort = end.effort;
  return fmt::format(
      "{} particles, {} of them on the boundary; {} of {} steps, {} evaluations, {} cuts, {} "
      "relaxation steps, {} factorisations, {} with advanced history; {:.2f} s of CPU, {:.2f} s "
      "elapsed{}",
      end.particles, end.boundary, end.steps, end.steps_wanted, effort.evaluations, effort.cuts,
      effort.relaxation_steps, effort.factorisations, effort.history_advanced, end.cpu, end.elapsed,
      end.steps < end.steps_wanted ? "\n  ended: " + end.text : "");
}

}  // namespace

SpecimenEnd run_specimen(const SpecimenScene& scene, const std::filesystem::path& stem) {
  Specimen specimen(scene, stem);
  Written written(stem);
  written.add("_specimen_*.csv");
  History history(stem, 2, has_drag(scene.material));
  written.add(".csv");
  std::optional<Progress> progress(scene.name);
  std::optional<Record> start;
  std::vector<SnapshotPanel> panels;
  int steps = 0, done = 0;
  for (const SpecimenSegment& segment : scene.segments) steps += segment.steps;
  const auto observe = [&](const grainlaw_state* state, const Record& record) {
    if (!start) {
      start = record;
      print_start(scene.name, measure_start(state, scene.material));
    }
    done = record.step;
    history.add(record);
    if (scene.vtk_every > 0 && record.step % scene.vtk_every == 0) {
      write_vtk(state, stem, record.step);
      written.add("_STEP.vtp");
    }
    const double strain = axial_strain(record, *start);
    constexpr double rounding = 1e-9;
    while (panels.size() < scene.pictures.size() &&
           strain > scene.pictures[panels.size()] - rounding)
      panels.push_back({strain_text(axial_abscissa, strain), take_snapshot(state)});
    progress->update(static_cast<double>(record.step) / steps,
                     fmt::format("axial strain {:.2f} %, sigma22 {:.1f} kPa", 100 * strain,
                                 record.cauchy(1, 1) / 1e3));
    if (record.step < steps) Interrupt::check();
  };
  const auto observe_cut = [&](double part, const std::string& reason) {
    progress->update(static_cast<double>(done) / steps, describe_cut(done + 1, part, reason));
    Interrupt::check();
  };
  std::exception_ptr stopped;
  SpecimenEnd end = specimen.run(observe, observe_cut, stopped);
  write_cost(end, stem.string() + "_cost.csv");
  written.add("_cost.csv");
  progress.reset();
  written.add_pictures(history.draw_figure(axial_abscissa));
  if (!panels.empty() &&
      draw_snapshots(panels, scene.picture_force, "", stem.string() + "_packing"))
    written.add("_packing.svg");
  fmt::print("{}: {}{}\n{}\n", scene.name, description(end), history.much_drag(), written.text());
  if (stopped) std::rethrow_exception(stopped);
  if (end.steps < end.steps_wanted && !scene.may_end) throw ComputationError(end.text);
  return end;
}

}  // namespace verification

#include "dns/run.hpp"

#include "app/history.hpp"
#include "app/progress.hpp"
#include "app/snapshot.hpp"

#include <fmt/format.h>

namespace verification {
namespace {

// Since the start, compression positive.
double axial_strain(const Record& record, const Record& start) {
  return 1 - record.deformation(1, 1) / start.deformation(1, 1);
}

void write_cost(const SpecimenEnd& end, const std::filesystem::path& path) {
  CsvWriter table(path, {"particles[-]", "boundary[-]", "steps[-]", "steps_wanted[-]",
                         "evaluations[-]", "relaxation_steps[-]", "factorisations[-]", "cuts[-]",
                         "history_advanced[-]", "cpu[s]", "elapsed[s]"});
  const Effort& effort = end.effort;
  table.row({static_cast<double>(end.particles), static_cast<double>(end.boundary),
             static_cast<double>(end.steps), static_cast<double>(end.steps_wanted),
             static_cast<double>(effort.evaluations), static_cast<double>(effort.relaxation_steps),
             static_cast<double>(effort.factorisations), static_cast<double>(effort.cuts),
             static_cast<double>(effort.history_advanced), end.cpu, end.elapsed});
}

}  // namespace

SpecimenEnd run_specimen(const SpecimenScene& scene, const std::filesystem::path& stem) {
  Specimen specimen(scene, stem);
  History history(stem);
  Progress progress(scene.name);
  std::optional<Record> start;
  std::vector<SnapshotPanel> panels;
  int steps = 0, done = 0;
  for (const SpecimenSegment& segment : scene.segments) steps += segment.steps;
  const std::string prefix = stem.string() + "_state";
  const auto observe = [&](const grainlaw_state* state, const Record& record) {
    if (!start) start = record;
    done = record.step;
    history.add(record);
    if (scene.vtk_every > 0 && record.step % scene.vtk_every == 0)
      write_vtk(state, stem, record.step);
    const double strain = axial_strain(record, *start);
    constexpr double rounding = 1e-9;
    while (panels.size() < scene.pictures.size() &&
           strain > scene.pictures[panels.size()] - rounding)
      panels.push_back({fmt::format("axial strain {:.3g}", strain), take_snapshot(state, prefix)});
    progress.update(static_cast<double>(record.step) / steps,
                    fmt::format("axial strain {:.2f} %, sigma22 {:.1f} kPa", 100 * strain,
                                record.cauchy(1, 1) / 1e3));
  };
  const auto observe_cut = [&](double part, const std::string& reason) {
    progress.update(static_cast<double>(done) / steps, describe_cut(done + 1, part, reason));
  };
  const SpecimenEnd end = specimen.run(observe, observe_cut);
  write_cost(end, stem.string() + "_cost.csv");
  history.draw_figure(axial_abscissa, scene.name);
  if (!panels.empty())
    draw_snapshots(panels, scene.picture_force, scene.name, stem.string() + "_packing");
  for (const char* suffix : {"_particles.csv", "_contacts.csv", "_cell.csv", ".vtp"})
    std::filesystem::remove(prefix + suffix);
  return end;
}

}  // namespace verification

#include "point/run.hpp"

#include "app/cpu_time.hpp"
#include "app/history.hpp"
#include "app/progress.hpp"
#include "app/snapshot.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace verification {
namespace {

double abscissa(const PointScene& scene, const Record& record) {
  return scene.abscissa == shear_abscissa ? record.deformation(0, 1) : record.axial_strain();
}

// What is written and drawn beside the history of a run.
class Observer {
 public:
  Observer(const PointScene& scene, const std::filesystem::path& stem)
      : scene_(scene), stem_(stem) {
    if (scene.particle_measures)
      measures_.emplace(stem.string() + "_particles.csv",
                        std::vector<std::string>{"step[-]", "F12[-]", "normalised_overlap[-]",
                                                 "mean_rotation_magnitude[rad]"});
  }

  void see(const grainlaw_state* state, const Record& record) {
    if (scene_.vtk_every > 0 && record.step % scene_.vtk_every == 0)
      write_vtk(state, stem_, record.step);
    const std::string prefix = stem_.string() + "_state";
    std::optional<Snapshot> snapshot;
    if (measures_) {
      snapshot = take_snapshot(state, prefix);
      measures_->row({static_cast<double>(record.step), record.deformation(0, 1),
                      normalised_overlap(*snapshot), mean_rotation_magnitude(*snapshot)});
    }
    constexpr double rounding = 1e-9;
    const double strain = abscissa(scene_, record);
    const bool backwards = !scene_.pictures.empty() && scene_.pictures.back() < 0;
    while (panels_.size() < scene_.pictures.size()) {
      // Of negative abscissae the first one to come is the largest.
      const double wanted = backwards ? scene_.pictures[scene_.pictures.size() - 1 - panels_.size()]
                                      : scene_.pictures[panels_.size()];
      if (backwards ? strain > wanted + rounding : strain < wanted - rounding) break;
      if (!snapshot) snapshot = take_snapshot(state, prefix);
      const char* name = scene_.abscissa == shear_abscissa ? "F12" : "axial strain";
      panels_.push_back({fmt::format("{} = {:.3g}", name, strain), *snapshot});
    }
  }

  void draw() const {
    if (!panels_.empty())
      draw_snapshots(panels_, scene_.picture_force, scene_.name, stem_.string() + "_packing");
    for (const char* end : {"_particles.csv", "_contacts.csv", "_cell.csv", ".vtp"})
      std::filesystem::remove(stem_.string() + "_state" + end);
  }

 private:
  const PointScene& scene_;
  std::filesystem::path stem_;
  std::optional<CsvWriter> measures_;
  std::vector<SnapshotPanel> panels_;
};

}  // namespace

PointEnd run_point(const PointScene& scene, const std::filesystem::path& stem) {
  PointEnd end;
  for (const Segment& segment : scene.segments) end.steps_wanted += segment.steps;
  if (scene.options.max_steps > 0)
    end.steps_wanted = std::min(end.steps_wanted, scene.options.max_steps);
  Material material;
  try {
    material = make_material(scene.material);
  } catch (const ComputationError& error) {
    if (!scene.may_end) throw;
    std::filesystem::remove(stem.string() + ".csv");  // of an earlier run
    end.status = GRAINLAW_NOT_CONVERGED;
    end.text = error.what();
    fmt::print("{}: {}\n", scene.name, end.text);
    return end;
  }
  History history(stem);
  Observer observer(scene, stem);
  double start = cpu_seconds();
  PointDriver driver(material, scene.options);
  end.cpu += cpu_seconds() - start;
  PackingStart begin = look_at_start(driver.state(), scene.material, stem.string() + "_state");
  for (std::string& text : far_targets(begin, scene.segments))
    begin.unusual.push_back(std::move(text));
  warn(scene.name, begin);
  end.particles = begin.particles;
  history.add(driver.record());
  observer.see(driver.state(), driver.record());

  Progress progress(scene.name);
  const auto observe = [&](const PointStep& step) {
    end.cpu += cpu_seconds() - start;
    const Record& record = step.record;
    end.effort.add(record.effort);
    history.add(record);
    observer.see(step.state, record);
    progress.update(
        static_cast<double>(record.step) / end.steps_wanted,
        fmt::format("sigma22 {:.1f} kPa, F22 {:.4f}, F12 {:.4f}", record.cauchy(1, 1) / 1e3,
                    record.deformation(1, 1), record.deformation(0, 1)));
    start = cpu_seconds();
  };
  const auto observe_cut = [&](double part, const std::string& reason) {
    const int done = driver.record().step;
    progress.update(static_cast<double>(done) / end.steps_wanted,
                    describe_cut(done + 1, part, reason));
  };
  start = cpu_seconds();
  try {
    for (const Segment& segment : scene.segments) driver.run(segment, observe, observe_cut);
  } catch (const StepError& error) {
    end.status = error.status;
    end.text = error.what() + why_at_start(begin, driver.record().step,
                                           smaller_steps(begin, scene.segments.front()));
  }
  end.cpu += cpu_seconds() - start;
  end.steps = driver.record().step;
  end.deformation = driver.record().deformation;
  if (scene.figure) history.draw_figure(scene.abscissa, scene.name);
  observer.draw();
  fmt::print("{}: {}{}\nwrote {}.csv{}\n", scene.name, history.summary(),
             end.steps < end.steps_wanted ? "\n  ended: " + end.text : "", stem.string(),
             scene.figure ? ", .svg, .png" : "");
  return end;
}

}  // namespace verification

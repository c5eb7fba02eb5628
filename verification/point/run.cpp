#include "point/run.hpp"

#include "app/cpu_time.hpp"
#include "app/history.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/snapshot.hpp"
#include "app/state_files.hpp"
#include "app/written.hpp"
#include "point/figures.hpp"
#include "point/laboratory_test.hpp"
#include "point/start.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <optional>

namespace verification {
namespace {

template <int D>
double abscissa(const PointScene& scene, const RecordOf<D>& record) {
  if (scene.abscissa == axial_abscissa) return record.axial_strain();
  return record.deformation(scene.abscissa[1] - '1', scene.abscissa[2] - '1');
}

// Writer of snapshots and pictures beside the history of a run.
class Observer {
 public:
  Observer(const PointScene& scene, const std::filesystem::path& stem, Written& written)
      : scene_(scene), stem_(stem), written_(written) {
    if (!scene.particle_measures) return;
    measures_.emplace(stem.string() + "_particles.csv",
                      std::vector<std::string>{"step[-]", "F12[-]", "normalised_overlap[-]",
                                               "mean_rotation_magnitude[rad]"});
    written.add("_particles.csv");
  }

  template <int D>
  void see(const grainlaw_state* state, const RecordOf<D>& record) {
    if (scene_.vtk_every > 0 && record.step % scene_.vtk_every == 0) {
      write_vtk(state, stem_, record.step);
      written_.add("_STEP.vtp");
    }
    std::optional<Snapshot> snapshot;
    if (measures_) {
      snapshot = take_snapshot(state);
      measures_->row({static_cast<double>(record.step), record.deformation(0, 1),
                      normalised_overlap(*snapshot), mean_rotation_magnitude(*snapshot)});
    }
    constexpr double rounding = 1e-9;
    const double strain = abscissa(scene_, record);
    const bool backwards = !scene_.pictures.empty() && scene_.pictures.back() < 0;
    while (panels_.size() < scene_.pictures.size()) {
      // Negative abscissae are passed from the largest to the smallest.
      const double wanted = backwards ? scene_.pictures[scene_.pictures.size() - 1 - panels_.size()]
                                      : scene_.pictures[panels_.size()];
      if (backwards ? strain > wanted + rounding : strain < wanted - rounding) break;
      if (!snapshot) snapshot = take_snapshot(state);
      panels_.push_back({strain_text(scene_.abscissa, strain), *snapshot});
    }
  }

  void draw() const {
    if (panels_.size() < scene_.pictures.size())
      tell(fmt::format("{}: pictures: the path reaches {} of {} values of {}\n", scene_.name,
                       panels_.size(), scene_.pictures.size(), scene_.abscissa));
    if (!panels_.empty() &&
        draw_snapshots(panels_, scene_.picture_force, "", stem_.string() + "_packing"))
      written_.add("_packing.svg");
  }

 private:
  const PointScene& scene_;
  std::filesystem::path stem_;
  Written& written_;
  std::optional<CsvWriter> measures_;
  std::vector<SnapshotPanel> panels_;
};

bool has_tests(const PointScene& scene) {
  return std::any_of(scene.segments.begin(), scene.segments.end(),
                     [](const Segment& segment) { return segment.test != nullptr; });
}

template <int D>
void run_path(const PointScene& scene, const std::filesystem::path& stem, PointEnd& end) {
  end = {};
  for (const Segment& segment : scene.segments) end.steps_wanted += segment.steps;
  const int whole = end.steps_wanted;
  if (scene.options.max_steps > 0)
    end.steps_wanted = std::min(end.steps_wanted, scene.options.max_steps);
  double start = cpu_seconds();
  std::optional<Material> material;
  try {
    material = make_material(scene.material, D);
  } catch (const ComputationError& error) {
    std::filesystem::remove(stem.string() + ".csv");  // of an earlier run
    end.cpu = cpu_seconds() - start;
    end.status = GRAINLAW_NOT_CONVERGED;
    end.text = error.what();
    if (!scene.may_end) throw;
    fmt::print("{}: {:.2f} s of CPU\n  ended: {}\n", scene.name, end.cpu, end.text);
    return;
  }
  Written written(stem);
  History history(stem, D, has_drag(scene.material));
  written.add(".csv");
  Observer observer(scene, stem, written);
  start = cpu_seconds();
  PointDriverOf<D> driver(*material, scene.options);
  end.cpu += cpu_seconds() - start;
  PackingStart begin = measure_start(driver.state(), scene.material);
  for (std::string& text : far_targets(begin, scene.segments))
    begin.unusual.push_back(std::move(text));
  print_start(scene.name, begin);
  end.particles = begin.particles;
  history.add(driver.record());
  observer.see(driver.state(), driver.record());

  std::optional<Progress> progress(scene.name);
  // Tells where the path leaves the usual stiffness, once: kn/p goes as one over overlaps and contacts.
  const double overlaps = driver.record().mean_overlap * driver.record().coordination;
  bool usual = unusual_stiffness(begin.stiffness).empty();
  const auto watch_stiffness = [&](const RecordOf<D>& record) {
    const double now = record.mean_overlap * record.coordination;
    const std::string text = unusual_stiffness(now > 0 ? begin.stiffness * overlaps / now : 0);
    if (!usual || text.empty()) return;
    usual = false;
    tell(fmt::format("{}: unusual from step {} on: {}\n", scene.name, record.step, text));
  };
  // Tells of the first step that left parts out of balance, where nobody asked for that.
  bool balanced = scene.options.loose_tolerance == 0;
  const auto watch_balance = [&](const RecordOf<D>& record) {
    if (!balanced || record.effort.loose == 0) return;
    balanced = false;
    tell(fmt::format(
        "{}: step {} left {} out of balance, across jumps of the stress: prescribed "
        "stresses are not met there (loose_parts in the table); try more steps, "
        "solver.viscous_number = 1e-3, or strain in place of stress\n",
        scene.name, record.step,
        record.effort.loose == 1 ? "a part" : fmt::format("{} parts", record.effort.loose)));
  };
  const auto observe = [&](const PointStepOf<D>& step) {
    end.cpu += cpu_seconds() - start;
    const RecordOf<D>& record = step.record;
    end.effort.add(record.effort);
    history.add(record);
    observer.see(step.state.get(), record);
    watch_stiffness(record);
    watch_balance(record);
    progress->update(std::min(1.0, static_cast<double>(record.step) / end.steps_wanted),
                     fmt::format("sigma{0}{0} {1:.1f} kPa, F{0}{0} {2:.4f}, F12 {3:.4f}", D,
                                 record.cauchy(D - 1, D - 1) / 1e3,
                                 record.deformation(D - 1, D - 1), record.deformation(0, 1)));
    if (record.step < end.steps_wanted) Interrupt::check();
    start = cpu_seconds();
  };
  const auto observe_cut = [&](double part, const std::string& reason) {
    const int done = driver.record().step;
    progress->update(static_cast<double>(done) / end.steps_wanted,
                     describe_cut(done + 1, part, reason));
    Interrupt::check();
  };
  start = cpu_seconds();
  std::exception_ptr stopped;
  bool told_later = false;           // as an error of the command
  std::vector<std::string> reached;  // by tests that stop before their strain or stress
  const Segment* led = nullptr;
  try {
    for (const Segment& segment : scene.segments) {
      led = &segment;
      const TestEnd test = driver.run(segment, observe, observe_cut);
      if (!test.text.empty()) reached.push_back(test.text);
      if (test.liquefied) break;
    }
    // The number of steps is known once tests have stopped.
    if (has_tests(scene) && !driver.left()) end.steps_wanted = driver.record().step;
    if (!reached.empty()) end.text = fmt::format("{}", fmt::join(reached, "; "));
  } catch (const StepError& error) {
    end.status = error.status;
    end.text = error.what() + path_advice(begin, driver.record().step, error.status, *led,
                                          components_of<D>(driver.record().cauchy));
    told_later = !scene.may_end;
    if (told_later) stopped = std::make_exception_ptr(StepError(error.status, end.text));
  } catch (const Interrupted& stop) {
    stopped = std::current_exception();
    end.text =
        fmt::format("{} after step {} of {}", stop.text(), driver.record().step, end.steps_wanted);
  }
  end.cpu += cpu_seconds() - start;
  end.effort.add(driver.unfinished());
  end.steps = driver.record().step;
  end.deformation.template topLeftCorner<D, D>() = driver.record().deformation;
  if (driver.left() && end.steps < whole)
    end.text = fmt::format("left after step {} of {} as asked", end.steps, whole);
  progress.reset();
  if (scene.figure) {
    written.add_pictures(history.draw_figure(scene.abscissa));
    for (const std::string& name : scene.figures) {
      const std::string file = figure_end(name);
      if (draw_path_figure(name, read_csv(stem.string() + ".csv"), scene.shear, scene.abscissa,
                           stem.string() + file))
        written.add(file + ".svg");
    }
  }
  observer.draw();
  fmt::print("{}: {}; {:.2f} s of CPU{}\n{}\n", scene.name, history.summary(driver.unfinished()),
             end.cpu, told_later || end.text == PointEnd().text ? "" : "\n  ended: " + end.text,
             written.text());
  if (stopped) std::rethrow_exception(stopped);
}

}  // namespace

void run_point(const PointScene& scene, const std::filesystem::path& stem, PointEnd& end) {
  scene.dimension == 3 ? run_path<3>(scene, stem, end) : run_path<2>(scene, stem, end);
}

}  // namespace verification

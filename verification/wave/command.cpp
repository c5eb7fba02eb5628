// `grainlaw wave SCENE.toml`: a pulse through a specimen of particles, and through meshes of its
// representative volumes.

#include "app/cases.hpp"
#include "app/commands.hpp"
#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/interrupt.hpp"
#include "app/output.hpp"
#include "app/written.hpp"
#include "point/start.hpp"
#include "wave/run.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace verification {
namespace {

bool draw_case(const WaveCase& one, const std::vector<WaveRun>& runs,
               const std::filesystem::path& stem) {
  constexpr std::array<const char*, 5> colours{colour::sky, colour::blue, colour::green,
                                               colour::purple, colour::amber};
  Figure figure{"", "time [ms]", {}};
  const auto curve = [](const WaveRun& run, const auto& value) {
    Curve curve;
    for (const WaveRow& row : run.rows) {
      curve.x.push_back(1e3 * row.time);
      curve.y.push_back(value(row));
    }
    return curve;
  };
  const auto add = [&](const std::string& ordinate, const auto& value, bool with_end) {
    Panel panel{ordinate, {}, 1.2};
    const bool first = figure.panels.empty();
    std::size_t k = 0;
    for (const WaveRun& run : runs) {
      Curve one_curve = curve(run, value);
      const bool particles = run.points == 0;
      if (first) one_curve.title = particles ? "particles" : run.name + " elements";
      one_curve.colour = particles ? colour::orange : colours[k++ % colours.size()];
      one_curve.stroke = particles ? Stroke::solid : Stroke::thin;
      panel.curves.push_back(one_curve);
    }
    if (with_end) {
      Curve pulse =
          curve(runs.front(), [&](const WaveRow& row) { return row.end / one.pulse.amplitude; });
      if (first) pulse.title = "pulse";
      pulse.colour = colour::grey;
      pulse.stroke = Stroke::dashed;
      panel.curves.push_back(pulse);
    }
    figure.panels.push_back(panel);
  };
  for (std::size_t k = 0; k < one.sections.size(); ++k)
    add(
        fmt::format("u / A at {:.4g} mm [-]", 1e3 * one.sections[k]),
        [&](const WaveRow& row) { return row.displacement[k] / one.pulse.amplitude; }, true);
  for (std::size_t k = 0; k < one.windows.size(); ++k)
    add(
        fmt::format("-P22 at {:.4g} to {:.4g} mm [kPa]", 1e3 * one.windows[k][0],
                    1e3 * one.windows[k][1]),
        [&](const WaveRow& row) { return -1e-3 * row.stress[k]; }, false);
  return draw(figure, stem);
}

// Runs the particles first; each mesh is compared with them as it finishes.
void run_case(const WaveCase& one, const std::filesystem::path& stem) {
  const WaveDomain domain = wave_domain(one);
  print_start(one.name, measure_start(State(make_material(one.material)).get(), one.material));
  std::vector<WaveRun> runs{run_particles(one)};
  std::vector<std::string> columns{"elements[-]",  "particles[-]",    "steps[-]", "cuts[-]",
                                   "time_step[s]", "core_seconds[s]", "wall[s]"};
  for (std::size_t k = 0; k < one.sections.size(); ++k) {
    columns.push_back(fmt::format("largest_error_{}[-]", k + 1));
    columns.push_back(fmt::format("rms_error_{}[-]", k + 1));
  }
  CsvWriter table(stem.string() + "_cost.csv", columns);
  Written written(stem);
  written.add("_cost.csv");
  // Prints a run; returns whether it is complete.
  const auto finish = [&](const WaveRun& run) {
    const bool particles = run.points == 0;
    const std::string end = particles ? "_dns.csv" : "_fe" + run.name + ".csv";
    write_rows(run, one, stem.string() + end);
    written.add(end);
    std::vector<double> row{static_cast<double>(run.points),
                            static_cast<double>(run.particles),
                            static_cast<double>(run.steps),
                            static_cast<double>(run.cuts),
                            run.time_step,
                            run.cpu,
                            run.wall};
    std::string errors;
    for (std::size_t k = 0; k < one.sections.size(); ++k) {
      const WaveError error = difference(run, runs.front(), k, one.pulse.amplitude);
      row.push_back(error.largest);
      row.push_back(error.mean_square);
      errors += fmt::format(" {:.2e}", error.largest);
    }
    table.row(row);
    fmt::print("{}: {}, {} particles, {} steps, {:.2f} core-seconds{}{}\n", one.name,
               particles ? "particles" : run.name + " elements", run.particles, run.steps, run.cpu,
               particles || errors.empty() ? "" : "; largest |du| / A against particles:" + errors,
               run.stopped ? fmt::format("\n  ended after {:.4g} of {:.4g} ms{}",
                                         run.rows.empty() ? 0 : 1e3 * run.rows.back().time,
                                         1e3 * one.duration, run.reason())
                           : "");
    return !run.stopped;
  };
  bool whole = finish(runs.front());
  for (std::size_t k = 0; whole && k < one.divisions.size(); ++k) {
    runs.push_back(run_mesh(one, domain, one.divisions[k]));
    whole = finish(runs.back());
  }
  const std::exception_ptr stopped = runs.back().stopped;
  std::erase_if(runs, [](const WaveRun& run) { return run.rows.empty(); });
  if (!runs.empty()) written.add_pictures(draw_case(one, runs, stem));
  fmt::print("{}\n", written.text());
  if (stopped) std::rethrow_exception(stopped);
}

void run_wave(const std::string& path, const std::string& only, const Destination& destination) {
  const WaveScene waves = read_wave_scene(SceneFile(path));
  std::vector<const WaveCase*> chosen;
  for (const WaveCase& one : waves.cases)
    if (only.empty() || one.name == waves.name + "_" + only) chosen.push_back(&one);
  if (chosen.empty()) throw InputError(fmt::format("{}: there is no case {}", path, only));
  Outputs outputs;
  std::vector<std::filesystem::path> inputs{path};
  for (const WaveCase* one : chosen) {
    outputs.add(one->name, one->name, {"_cost.csv", "_dns.csv"});
    outputs.add_pictures(one->name, one->name);
    for (const int divisions : one->divisions)
      outputs.add(one->name, fmt::format("{}_fe{}", one->name, divisions), {".csv"});
    for (auto& file : files_of(one->material)) inputs.push_back(std::move(file));
  }
  outputs.check_apart(path);
  const OwnFiles own = destination.claim(outputs, inputs);
  CaseFailures failures(chosen.size());
  const Interrupt interrupt;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    failures.guard(k, chosen[k]->name,
                   [&] { run_case(*chosen[k], destination.stem(chosen[k]->name)); });
  failures.check(path);
}

}  // namespace

void add_wave_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "wave",
      "send a pulse through a specimen of particles, and through meshes of the same packing");
  auto scene = std::make_shared<std::string>();
  auto destination = std::make_shared<Destination>();
  auto only = std::make_shared<std::string>();
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  destination->add_options(*command);
  command->add_option("--case", *only, "this case alone");
  command->callback([scene, destination, only] { run_wave(*scene, *only, *destination); });
}

}  // namespace verification

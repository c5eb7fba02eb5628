#include "evidence/studies/reach/tables.hpp"

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace verification::reach {
namespace {

constexpr double bar_direct = 0.99;
constexpr double bar_exact = 0.999;  // without advancing the history
constexpr std::array<const char*, 4> ending_names{"direct", "sub-increments", "advanced history",
                                                  "failed"};

// Increments and how they ended, of one path or of several.
struct Tally {
  std::array<double, 4> ended{};
  std::vector<double> steps, factorisations, cpu;
  double worst_residual = 0;  // of those that were solved [-]
  double rounded = 0;         // solved as far as rounding lets, not to the tolerance
  double hardest = 0;         // Pi [-]

  void add(const Path& path, double tolerance) {
    for (const Increment& increment : path.increments) {
      ended[static_cast<std::size_t>(increment.ending)] += 1;
      steps.push_back(static_cast<double>(increment.report.relaxation_steps));
      factorisations.push_back(increment.report.factorisations);
      cpu.push_back(increment.cpu);
      hardest = std::max(hardest, increment.hardness);
      if (increment.status != GRAINLAW_OK) continue;
      worst_residual = std::max(worst_residual, increment.report.residual);
      rounded += increment.report.residual > tolerance ? 1 : 0;
    }
  }
  [[nodiscard]] double count() const { return static_cast<double>(steps.size()); }
  [[nodiscard]] double direct() const { return ended[0] / count(); }
  [[nodiscard]] double exact() const { return (ended[0] + ended[1]) / count(); }
};

const std::vector<std::string> tally_columns{"increments[-]",
                                             "direct[-]",
                                             "split[-]",
                                             "advanced[-]",
                                             "failed[-]",
                                             "share_direct[-]",
                                             "Pi_max[-]",
                                             "residual_max[-]",
                                             "above_tolerance[-]",
                                             "steps_mean[-]",
                                             "steps_median[-]",
                                             "steps_max[-]",
                                             "factorisations_mean[-]",
                                             "factorisations_median[-]",
                                             "factorisations_max[-]",
                                             "cpu_mean[ms]",
                                             "cpu_median[ms]",
                                             "cpu_max[ms]"};

void append(std::vector<Table::Cell>& cells, const Tally& tally) {
  cells.push_back(tally.count());
  for (const double number : tally.ended) cells.push_back(number);
  for (const double number : {tally.direct(), tally.hardest, tally.worst_residual, tally.rounded})
    cells.push_back(number);
  for (const auto* values : {&tally.steps, &tally.factorisations, &tally.cpu})
    for (const double number : {average(*values), median(*values), largest(*values)})
      cells.push_back(number);
}

std::vector<std::string> with_tally(std::vector<std::string> columns) {
  columns.insert(columns.end(), tally_columns.begin(), tally_columns.end());
  return columns;
}

void tabulate_paths(const std::vector<Path>& paths, double tolerance,
                    const std::filesystem::path& output) {
  Table table(
      "increment by increment, exact tangent included; split: into sub-increments; "
      "above_tolerance: "
      "as near as rounding allows",
      with_tally(
          {"path", "packing", "kn_over_p[-]", "friction[-]", "strain_end[-]", "pressure_end[-]"}));
  for (const Path& path : paths) {
    if (path.increments.empty()) continue;
    Tally tally;
    tally.add(path, tolerance);
    std::vector<Table::Cell> cells{
        path.kind,    path.packing, path.stiffness, path.friction, path.increments.back().strain,
        path.pressure};
    append(cells, tally);
    table.row(cells);
  }
  table.print();
  table.write(output / "reach.csv");
  for (const Path& path : paths)
    if (!path.gave_up.empty())
      fmt::print("{} of {} with friction {} ended at {} increments: {}\n", path.kind, path.packing,
                 path.friction, path.increments.size(), path.gave_up);
}

// Paths that count together.
struct Group {
  std::string name;
  std::function<bool(const Path&)> belongs;
};

std::vector<Group> groups() {
  std::vector<Group> result;
  const auto ours = [](const Path& path) { return path.packing != "yade400"; };
  for (const char* kind : {"drained", "shear"})
    result.push_back({fmt::format("yade400 {}", kind),
                      [=](const Path& path) { return !ours(path) && path.kind == kind; }});
  for (const char* kind : {"drained", "isochoric", "shear"})
    result.push_back({fmt::format("grid {}", kind),
                      [=](const Path& path) { return ours(path) && path.kind == kind; }});
  for (const double stiffness : {1e2, 1e3, 1e4, 1e5, 1e6})
    result.push_back({fmt::format("grid kn/p = {:.0e}", stiffness),
                      [=](const Path& path) { return ours(path) && path.stiffness == stiffness; }});
  for (const double friction : {0.0, 0.2, 0.4, 0.5, 0.6, 0.8})
    result.push_back({fmt::format("grid friction {}", friction),
                      [=](const Path& path) { return ours(path) && path.friction == friction; }});
  result.push_back({"all", [](const Path&) { return true; }});
  return result;
}

Tally tally_of(const Group& group, const std::vector<Path>& paths, double tolerance) {
  Tally tally;
  for (const Path& path : paths)
    if (group.belongs(path)) tally.add(path, tolerance);
  return tally;
}

void tabulate_groups(const std::vector<Path>& paths, double tolerance,
                     const std::filesystem::path& output) {
  Table table(
      fmt::format("together, to {:.0e}; the bars: {:g} % direct, {:g} % without advancing the "
                  "history",
                  tolerance, 100 * bar_direct, 100 * bar_exact),
      with_tally({"group", "share_without_advancing[-]", "bars_met"}));
  for (const Group& group : groups()) {
    const Tally tally = tally_of(group, paths, tolerance);
    if (tally.steps.empty()) continue;
    const bool met = tally.direct() >= bar_direct && tally.exact() >= bar_exact;
    std::vector<Table::Cell> cells{group.name, tally.exact(), met ? "yes" : "no"};
    append(cells, tally);
    table.row(cells);
  }
  table.print();
  table.write(output / "reach_groups.csv");
}

void tabulate_rest(const std::vector<Path>& paths, const std::filesystem::path& output) {
  Table table(
      "every increment that was not solved directly",
      {"path", "packing", "kn_over_p[-]", "friction[-]", "step[-]", "strain[-]", "Pi[-]", "ended",
       "parts[-]", "residual[-]", "steps[-]", "factorisations[-]", "status_changes[-]", "cpu[ms]"});
  for (const Path& path : paths)
    for (const Increment& increment : path.increments) {
      if (increment.ending == Ending::direct) continue;
      const bool failed = increment.ending == Ending::failed;
      const grainlaw_report& report = increment.report;
      std::string ended = ending_names[static_cast<std::size_t>(increment.ending)];
      if (failed) ended += fmt::format(" ({})", static_cast<int>(increment.status));
      table.row({path.kind, path.packing, path.stiffness, path.friction,
                 static_cast<double>(increment.step), increment.strain, increment.hardness, ended,
                 static_cast<double>(report.subincrements), report.residual,
                 static_cast<double>(report.relaxation_steps),
                 static_cast<double>(report.factorisations),
                 failed ? Table::Cell("") : Table::Cell(static_cast<double>(report.status_changes)),
                 increment.cpu});
    }
  table.print();
  table.write(output / "reach_rest.csv");
}

}  // namespace

void tabulate(const std::vector<Path>& paths, double tolerance,
              const std::filesystem::path& output) {
  tabulate_paths(paths, tolerance, output);
  tabulate_groups(paths, tolerance, output);
  tabulate_rest(paths, output);
}

void tabulate_repeats(const std::vector<std::vector<Path>>& repeats, double tolerance,
                      const std::filesystem::path& output) {
  const std::vector<std::pair<std::string, std::function<double(const Tally&)>>> quantities{
      {"not_direct[%]", [](const Tally& t) { return 100 * (1 - t.direct()); }},
      {"advanced_or_failed[%]", [](const Tally& t) { return 100 * (1 - t.exact()); }},
      {"steps[-]", [](const Tally& t) { return average(t.steps); }},
      {"factorisations[-]", [](const Tally& t) { return average(t.factorisations); }},
      {"cpu[ms]", [](const Tally& t) { return average(t.cpu); }}};
  std::vector<std::string> columns{"group", "repeats[-]", "increments[-]"};
  for (const auto& [name, value] : quantities) {
    columns.push_back(name);
    columns.push_back("error_of_" + name);
  }
  Table table(fmt::format("means of repeats whose stiffnesses differ by 1e-6, and their standard "
                          "errors; the bars: {:g} % not direct, {:g} % advanced or failed",
                          100 * (1 - bar_direct), 100 * (1 - bar_exact)),
              columns);
  for (const Group& group : groups()) {
    std::vector<Tally> tallies;
    for (const auto& paths : repeats) tallies.push_back(tally_of(group, paths, tolerance));
    if (tallies[0].steps.empty()) continue;
    std::vector<double> counts;
    for (const Tally& tally : tallies) counts.push_back(tally.count());
    std::vector<Table::Cell> cells{group.name, static_cast<double>(repeats.size()),
                                   average(counts)};
    for (const auto& [name, value] : quantities) {
      std::vector<double> values;
      for (const Tally& tally : tallies) values.push_back(value(tally));
      cells.push_back(average(values));
      cells.push_back(standard_error(values));
    }
    table.row(cells);
  }
  table.print();
  table.write(output / "reach_repeats.csv");
}

}  // namespace verification::reach

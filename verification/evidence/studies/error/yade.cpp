// YADE's cost of an increment against ours at equal error, and the bars of the drained path.

#include "evidence/studies/clock.hpp"
#include "evidence/studies/error/error.hpp"
#include "evidence/studies/statistics.hpp"

#include "app/progress.hpp"
#include "io/csv_records.hpp"
#include "io/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace verification::error_study {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct Interpolated {
  double cpu;  // without a tangent [ms]
  const char* how;
};

// CPU of our default method on the drained path at this median error, between the tolerances in
// log-log.
Interpolated cpu_at(const std::vector<IncrementRow>& rows, double error) {
  std::vector<std::pair<double, double>> points;
  for (const IncrementRow& row : rows)
    if (row.path == "drained" && row.method == direct.name && row.error_median > 0)
      points.emplace_back(std::log(row.error_median), std::log(row.cpu));
  std::sort(points.begin(), points.end());
  const double x = std::log(error);
  if (points.empty() || x < points.front().first) return {not_a_number, "beyond our tightest"};
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto& [x0, y0] = points[k - 1];
    const auto& [x1, y1] = points[k];
    if (x <= x1)
      return {std::exp(x1 > x0 ? y0 + (y1 - y0) * (x - x0) / (x1 - x0) : y1), "interpolated"};
  }
  return {std::exp(points.back().second), "our loosest; more accurate"};
}

const char* verdict(bool met) { return met ? "yes" : "no"; }

// Mean CPU time of an evaluation with the exact tangent over the increments of each long drained
// path [ms].
std::vector<double> time_long_paths(const StudyOptions& options, double tolerance, double axial,
                                    int paths) {
  std::vector<double> means;
  Progress progress("drained paths to 10 %");
  for (int repeat = 0; repeat < paths; ++repeat) {
    std::vector<double> cpu;
    const Material material = make_material(with_method(options, direct, tolerance, repeat));
    PointDriver driver(material, study_options());
    const int steps = static_cast<int>(std::lround(axial / increment_size));
    driver.run(drained_segment(-axial, drained_pressure, steps), [&](const PointStep& step) {
      progress.update((repeat + step.fraction) / paths, "");
      const auto [evaluation, spent] =
          time_evaluation(step.state, step.record.deformation, GRAINLAW_WANT_TANGENT_EXACT);
      if (evaluation.status == GRAINLAW_OK) cpu.push_back(spent);
    });
    means.push_back(average(cpu));
  }
  return means;
}

}  // namespace

double slower_than_recorded(double yade_step) {
  constexpr double recorded_step = 281;  // 100, 350, 690 and 5300 steps of 400 discs [ns]
  return yade_step > 0 ? yade_step / recorded_step : 1;
}

std::vector<YadeRow> read_yade(const StudyOptions& options, double slower) {
  const std::filesystem::path path = options.scene("reference/yade_cost.csv");
  const std::string text = as<InputError>([&] { return grainlaw::core::read_text(path.string()); });
  grainlaw::core::CsvRecords records(text);
  std::vector<YadeRow> rows;
  bool header = true;
  for (std::vector<std::string> fields; records.next(fields);) {
    if (fields.front().empty() || fields.front().front() == '#') continue;
    if (std::exchange(header, false)) continue;
    if (fields.size() != 5)
      throw InputError(
          fmt::format("{}:{}: found {} fields, expected setting,kind,error,cpu_low,"
                      "cpu_high",
                      path.string(), records.line(), fields.size()));
    YadeRow row{};
    row.setting = fields[0];
    row.kind = fields[1];
    row.error = std::strtod(fields[2].c_str(), nullptr);
    row.cpu_low = std::strtod(fields[3].c_str(), nullptr);
    row.cpu_high = std::strtod(fields[4].c_str(), nullptr);
    row.recorded = 0.5 * (row.cpu_low + row.cpu_high);
    row.cpu_low *= slower;
    row.cpu_high *= slower;
    rows.push_back(row);
  }
  return rows;
}

void compare_with_yade(const StudyOptions& options, const std::vector<IncrementRow>& increments,
                       const std::vector<YadeRow>& yade) {
  constexpr double bar_best = 10, bar_usual = 30, bar_tight = 100;
  constexpr double tight = 1e-8;
  Table table(
      "CPU of one increment of 0.1 % at equal median error: YADE's over ours (default method, "
      "without a tangent; YADE's middle where it gives a range)",
      {"yade_setting", "error[-]", "yade_recorded[ms]", "yade_cpu[ms]", "our_cpu[ms]", "our_cpu_is",
       "ratio[-]", "bar[-]", "met"});
  for (const YadeRow& row : yade) {
    const double theirs = 0.5 * (row.cpu_low + row.cpu_high);
    const auto [ours, how] = cpu_at(increments, row.error);
    const double ratio = theirs / ours;
    const double bar = row.kind == "coupling"     ? not_a_number
                       : row.error < 1.01 * tight ? bar_tight
                       : row.kind == "best"       ? bar_best
                                                  : bar_usual;
    table.row({row.setting, row.error, row.recorded, theirs, ours, how, ratio,
               std::isnan(bar) ? Table::Cell("none") : Table::Cell(bar),
               std::isnan(bar) ? "-" : verdict(ratio >= bar)});
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "error_yade.csv");
}

void study_budget(const StudyOptions& options, const std::vector<IncrementRow>& increments,
                  double slower) {
  constexpr double wanted_error = 1e-4, tight = 1e-8, long_axial = 0.1;
  constexpr int long_paths = 40;  // single ones differ beyond the peak, by rounding alone
  constexpr double bar_loose = 1.0, bar_tight = 2.0, bar_long = 6.0;  // [ms]
  Table table(
      fmt::format("drained path on the YADE packing, increments of 0.1 %, one thread; at the speed "
                  "of the machine YADE's times and the bars are of: divided by {:.3g}",
                  slower),
      {"range", "statistic", "tangent", "tolerance[-]", "error_median[-]", "cpu[ms]",
       "cpu_at_its_speed[ms]", "standard_error[ms]", "bar[ms]", "met"});
  const auto row = [&](const char* range, const std::string& statistic, const char* tangent,
                       double tolerance, const Table::Cell& error, double cpu,
                       const Table::Cell& standard_error, double bar) {
    table.row({range, statistic, tangent, tolerance, error, cpu, cpu / slower, standard_error, bar,
               verdict(cpu / slower <= bar)});
  };
  const IncrementRow* loosest = nullptr;
  const IncrementRow* tightest = nullptr;
  for (const IncrementRow& row : increments) {
    if (row.path != "drained" || row.method != direct.name) continue;
    if (loosest == nullptr && row.error_median <= wanted_error) loosest = &row;
    if (std::abs(std::log(row.tolerance / tight)) < 0.1) tightest = &row;
  }
  if (loosest != nullptr)
    row("up to 1.5 %", "median", "none", loosest->tolerance, loosest->error_median, loosest->cpu,
        "-", bar_loose);
  if (tightest != nullptr)
    row("up to 1.5 %", "median", "exact", tightest->tolerance, tightest->error_median,
        tightest->cpu_exact, "-", bar_tight);
  const std::vector<double> means = time_long_paths(options, tight, long_axial, long_paths);
  row("up to 10 %", fmt::format("mean of {} paths", long_paths), "exact", tight, "not measured",
      average(means), standard_error(means) / slower, bar_long);
  table.print();
  table.write(std::filesystem::path(options.output) / "error_budget.csv");
}

}  // namespace verification::error_study

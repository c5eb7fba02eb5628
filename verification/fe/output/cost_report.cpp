#include "fe/output/cost_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace verification {
namespace {

constexpr std::array<const char*, stages> stage_names{"points", "assembly", "linear_solve",
                                                      "output"};

int points_without_contacts(const PointField& points) {
  int count = 0;
  for (std::size_t p = 0; p < points.size(); ++p) count += points.report(p).contacts == 0 ? 1 : 0;
  return count;
}

}  // namespace

std::vector<std::string> cost_columns() {
  std::vector<std::string> names{"step[-]", "elapsed[s]", "core_time[s]"};
  for (const char* name : stage_names) names.push_back(fmt::format("{}_core_time[s]", name));
  names.insert(names.end(),
               {"median_point[ms]", "dearest_point[ms]", "evaluations[-]", "iterations[-]",
                "cuts[-]", "loose_parts[-]", "fallbacks[-]", "failed_points[-]"});
  return names;
}

std::vector<std::string> point_cost_columns(std::size_t points) {
  std::vector<std::string> names{"step[-]"};
  for (std::size_t p = 0; p < points; ++p) names.push_back(fmt::format("point{}[ms]", p));
  return names;
}

CostReport::CostReport(const Solver& solver, CsvWriter* points)
    : solver_(solver), points_(points), last_(now()) {}

CostReport::Reading CostReport::now() const {
  Reading reading{Spent::now(), {}, solver_.points().seconds()};
  for (std::size_t k = 0; k < stages; ++k)
    reading.stage[k] = solver_.points().cost().of(static_cast<Stage>(k));
  return reading;
}

void CostReport::add(const LoadStep& step, CsvWriter& table) {
  without_contacts_ = points_without_contacts(solver_.points());
  add(step.record.step, step.record.effort, table);
}

void CostReport::add_unfinished(int step, const Effort& effort, CsvWriter& table) {
  add(step, effort, table);
}

void CostReport::add(int step, const Effort& effort, CsvWriter& table) {
  const Reading reading = now();
  const Spent total = reading.total - last_.total;
  std::vector<double> row{static_cast<double>(step), total.elapsed, total.cpu};
  for (std::size_t k = 0; k < stages; ++k) row.push_back((reading.stage[k] - last_.stage[k]).cpu);
  std::vector<double> points(reading.points.size());
  std::transform(reading.points.begin(), reading.points.end(), last_.points.begin(), points.begin(),
                 [](double now, double before) { return 1e3 * (now - before); });
  if (points_ != nullptr) {
    std::vector<double> every{static_cast<double>(step)};
    every.insert(every.end(), points.begin(), points.end());
    points_->row(every);
  }
  std::sort(points.begin(), points.end());
  row.insert(row.end(), {points[points.size() / 2], points.back()});
  for (const int count : {effort.evaluations, effort.iterations, effort.cuts, effort.loose,
                          effort.history_advanced, without_contacts_})
    row.push_back(count);
  table.row(row);
  last_ = reading;
}

std::string cost_summary(const CsvTable& table, std::size_t points) {
  if (table.rows() == 0) return {};
  const auto sum = [&](const std::string& name, std::size_t first = 0) {
    const std::vector<double>& values = table[name];
    return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first), values.end(), 0.0);
  };
  // Step 0 is the start, not a load step; it counts in the totals alone.
  const std::size_t first = table["step"].front() == 0 ? 1 : 0;
  const auto steps = static_cast<double>(std::max<std::size_t>(table.rows() - first, 1));
  const double cpu = sum("core_time");
  std::string text = fmt::format(
      "{} points: {:.3f} core-milliseconds and {:.2f} evaluations per point and load step; "
      "{:.2f} core-seconds, {:.2f} s elapsed\n",
      points, 1e3 * sum("core_time", first) / (steps * static_cast<double>(points)),
      sum("evaluations", first) / steps, cpu, sum("elapsed"));
  double rest = cpu;
  std::vector<std::string> parts;
  const auto part = [&](std::string name, double spent) {
    std::replace(name.begin(), name.end(), '_', ' ');
    parts.push_back(fmt::format("{} {:.1f} %", name, 100 * spent / std::max(cpu, 1e-9)));
  };
  for (const std::string name : stage_names) {
    const double spent = sum(name + "_core_time");
    part(name, spent);
    rest -= spent;
  }
  part("rest", rest);
  const std::vector<double>& failed = table["failed_points"];
  return text +
         fmt::format("core-seconds went to {}\npoints without contacts: {:.0f}, at most {:.0f}\n",
                     fmt::join(parts, ", "), failed.back(),
                     *std::max_element(failed.begin(), failed.end()));
}

}  // namespace verification

#include "wave/run.hpp"

#include "app/csv.hpp"
#include "app/interrupt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace verification {
namespace {

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

}  // namespace

CostClock::CostClock() : cpu_(processor_seconds()), start_(std::chrono::steady_clock::now()) {}
double CostClock::cpu() const { return processor_seconds() - cpu_; }
double CostClock::wall() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string WaveRun::reason() const {
  if (!stopped) return {};
  try {
    std::rethrow_exception(stopped);
  } catch (const Interrupted& stop) {
    return std::string(": ") + stop.text();
  } catch (const std::exception&) {
    return {};
  }
}

void write_rows(const WaveRun& run, const WaveCase& one, const std::filesystem::path& path) {
  std::vector<std::string> columns{"time[s]", "end[m]"};
  for (std::size_t k = 0; k < one.sections.size(); ++k)
    columns.push_back(fmt::format("displacement_{}[m]", k + 1));
  for (std::size_t k = 0; k < one.windows.size(); ++k)
    columns.push_back(fmt::format("P22_{}[Pa]", k + 1));
  for (const char* name :
       {"work[J]", "kinetic[J]", "coherent[J]", "stored[J]", "dissipated[J]", "contacts[-]"})
    columns.emplace_back(name);
  std::vector<std::vector<double>> rows;
  for (const WaveRow& row : run.rows) {
    std::vector<double> values{row.time, row.end};
    values.insert(values.end(), row.displacement.begin(), row.displacement.end());
    values.insert(values.end(), row.stress.begin(), row.stress.end());
    for (const double value :
         {row.work, row.kinetic, row.coherent, row.stored, row.dissipated, row.contacts})
      values.push_back(value);
    rows.push_back(values);
  }
  write_csv(path, columns, rows);
}

WaveError difference(const WaveRun& run, const WaveRun& reference, std::size_t section,
                     double amplitude) {
  std::vector<double> times, values;
  for (const WaveRow& row : reference.rows) {
    times.push_back(row.time);
    values.push_back(row.displacement[section]);
  }
  WaveError error;
  double squares = 0;
  std::size_t count = 0;
  for (const WaveRow& row : run.rows) {
    const double other = interpolate(times, values, row.time);
    if (!std::isfinite(other)) continue;
    const double apart = (row.displacement[section] - other) / amplitude;
    error.largest = std::max(error.largest, std::abs(apart));
    squares += apart * apart;
    ++count;
  }
  if (count > 0) error.mean_square = std::sqrt(squares / static_cast<double>(count));
  return error;
}

}  // namespace verification

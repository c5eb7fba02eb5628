#include "app/csv.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace verification {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : stream_(path), columns_(columns.size()) {
  if (!stream_) throw ComputationError(fmt::format("{}: cannot be written", path.string()));
  stream_ << fmt::format("{}\n", fmt::join(columns, ","));
}

void CsvWriter::row(const std::vector<double>& values) {
  if (values.size() != columns_) throw std::logic_error("csv: a row of another length");
  // Flushed, so that an interrupted run leaves all of its finished steps.
  stream_ << fmt::format("{:.12g}\n", fmt::join(values, ",")) << std::flush;
}

const std::vector<double>& CsvTable::operator[](std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw InputError(fmt::format("a table has no column {}", name));
  return columns[static_cast<std::size_t>(found - names.begin())];
}

CsvTable read_csv(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::string line;
  if (!stream || !std::getline(stream, line))
    throw InputError(fmt::format("{}: cannot be read", path.string()));
  CsvTable table;
  for (const std::string& field : split(line))
    table.names.push_back(field.substr(0, field.find('[')));
  table.columns.resize(table.names.size());
  for (int number = 2; std::getline(stream, line); ++number) {
    const std::vector<std::string> fields = split(line);
    if (fields.size() != table.names.size())
      throw InputError(fmt::format("{}:{}: found {} fields, expected {}", path.string(), number,
                                   fields.size(), table.names.size()));
    for (std::size_t k = 0; k < fields.size(); ++k)
      table.columns[k].push_back(std::strtod(fields[k].c_str(), nullptr));
  }
  return table;
}

double interpolate(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto above = std::lower_bound(xs.begin(), xs.end(), x);
  if (above == xs.end() || (above == xs.begin() && *above > x))
    return std::numeric_limits<double>::quiet_NaN();
  const auto k = static_cast<std::size_t>(above - xs.begin());
  if (k == 0) return ys.front();
  return ys[k - 1] + (ys[k] - ys[k - 1]) * (x - xs[k - 1]) / (xs[k] - xs[k - 1]);
}

}  // namespace verification

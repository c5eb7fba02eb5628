#include "app/csv.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
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

std::string header(const std::vector<std::string>& columns) {
  return fmt::format("{}\n", fmt::join(columns, ","));
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : path_(path), stream_(path), columns_(columns.size()) {
  write(header(columns));
}

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
                     std::uintmax_t length)
    : path_(path), length_(length), columns_(columns.size()) {
  std::ifstream old(path);
  std::string line;
  std::getline(old, line);
  std::error_code error;
  const std::uintmax_t found = std::filesystem::file_size(path, error);
  if (error || found < length || line + "\n" != header(columns))
    throw InputError(fmt::format(
        "{}: cannot be continued: found {}, expected the table of the "
        "interrupted run with at least {} bytes",
        path.string(), error ? error.message() : fmt::format("{} bytes", found), length));
  std::filesystem::resize_file(path, length);
  stream_.open(path, std::ios::app);
  if (!stream_) throw ComputationError(fmt::format("{}: cannot be written", path.string()));
}

void CsvWriter::write(const std::string& line) {
  // Flushed, so that an interrupted run leaves all of its finished steps.
  if (!(stream_ << line << std::flush))
    throw ComputationError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  length_ += line.size();
}

void CsvWriter::row(const std::vector<double>& values) {
  if (values.size() != columns_) throw std::logic_error("csv: a row of another length");
  write(fmt::format("{:.12g}\n", fmt::join(values, ",")));
}

const std::vector<double>& CsvTable::operator[](std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(
        fmt::format("a table has no column {}; found {}", name, fmt::join(names, ",")));
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

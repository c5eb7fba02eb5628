#include "app/csv.hpp"

#include "app/library.hpp"
#include "io/csv_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <utility>

namespace verification {

using grainlaw::core::csv_record;
using grainlaw::core::CsvRecords;

namespace {

std::string line(const std::vector<double>& values, std::size_t columns) {
  if (values.size() != columns) throw std::logic_error("csv: a row of another length");
  return fmt::format("{:.12g}\n", fmt::join(values, ","));
}

struct Heading {
  std::string name, unit;
};

// Parts of "name[unit]", with blanks around the name; a name may contain brackets.
Heading heading_of(const std::string& column) {
  const auto bracket = column.ends_with(']') ? column.rfind('[') : std::string::npos;
  const std::string name = column.substr(0, bracket);
  const auto first = std::min(name.find_first_not_of(' '), name.size());
  Heading heading{name.substr(first, name.find_last_not_of(' ') + 1 - first), ""};
  if (bracket != std::string::npos)
    heading.unit = column.substr(bracket + 1, column.size() - bracket - 2);
  return heading;
}

double number_of(const std::string& field) {
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  const bool whole = end != field.c_str() &&
                     field.find_first_not_of(" \t", end - field.c_str()) == std::string::npos;
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

// Returns the length if the table there can be continued from it.
std::uintmax_t checked(const std::filesystem::path& path, const std::vector<std::string>& columns,
                       std::uintmax_t length) {
  const std::string expected = csv_record(columns);
  std::string found(expected.size(), '\0');
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) {
    std::ifstream old(path);
    old.read(found.data(), static_cast<std::streamsize>(found.size()));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size < length || found != expected)
    throw InputError(fmt::format(
        "{}: cannot be continued: found {}, expected the table of the "
        "interrupted run with at least {} bytes",
        path.string(), error ? error.message() : fmt::format("{} bytes", size), length));
  return length;
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : file_(path, csv_record(columns)), columns_(columns.size()) {}

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
                     std::uintmax_t length)
    : file_(path, checked(path, columns, length)), columns_(columns.size()) {}

void CsvWriter::row(const std::vector<double>& values) { file_.append(line(values, columns_)); }

void write_csv(const std::filesystem::path& path, const std::vector<std::string>& columns,
               const std::vector<std::vector<double>>& rows) {
  std::string text = csv_record(columns);
  for (const std::vector<double>& row : rows) text += line(row, columns.size());
  write_atomically(path, text);
}

bool CsvTable::has(std::string_view name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::vector<double>& CsvTable::operator[](std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(
        fmt::format("a table has no column {}; found {}", name, fmt::join(names, ",")));
  return columns[static_cast<std::size_t>(found - names.begin())];
}

CsvTable read_csv(const std::filesystem::path& path) {
  const std::string text = as<InputError>([&] { return grainlaw::core::read_text(path.string()); });
  CsvRecords records(text);
  CsvTable table;
  std::vector<std::string> fields;
  if (!records.next(fields)) throw InputError(fmt::format("{}: cannot be read", path.string()));
  for (const std::string& field : fields) {
    Heading heading = heading_of(field);
    table.names.push_back(std::move(heading.name));
    table.units.push_back(std::move(heading.unit));
  }
  table.columns.resize(table.names.size());
  while (records.next(fields)) {
    if (fields.size() != table.names.size())
      throw InputError(fmt::format("{}:{}: found {} fields, expected {}", path.string(),
                                   records.line(), fields.size(), table.names.size()));
    for (std::size_t k = 0; k < fields.size(); ++k)
      table.columns[k].push_back(number_of(fields[k]));
  }
  return table;
}

std::vector<std::string> read_csv_names(const std::filesystem::path& path) {
  const std::string text = as<InputError>([&] { return grainlaw::core::read_text(path.string()); });
  CsvRecords records(text);
  std::vector<std::string> names, fields;
  records.next(fields);
  while (records.next(fields)) names.push_back(fields.front());
  return names;
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

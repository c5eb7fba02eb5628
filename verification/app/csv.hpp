// Tables on disk: comma-separated values (RFC 4180) with one header of "name[unit]" columns.
#pragma once

#include "app/atomic_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

class CsvWriter {
 public:
  // Columns as "name[unit]", "[-]" when dimensionless. Throws ComputationError when the file cannot
  // be written.
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);

  // Goes on with a file of these columns after its first `length` bytes; what came after them is
  // dropped. Throws InputError when the file is shorter or has other columns.
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
            std::uintmax_t length);

  // One line, at once, so that an interrupted run leaves all of its finished steps; values in the order
  // of the columns. Throws ComputationError when it cannot be written.
  void row(const std::vector<double>& values);
  // Bytes written so far, header included.
  [[nodiscard]] std::uintmax_t length() const { return file_.length(); }
  [[nodiscard]] std::filesystem::path path() const { return file_.path(); }

 private:
  GrowingFile file_;
  std::size_t columns_;
};

// A whole table at once: the old one stays until the new one is on the disk. Throws ComputationError.
void write_csv(const std::filesystem::path& path, const std::vector<std::string>& columns,
               const std::vector<std::vector<double>>& rows);

struct CsvTable {
  std::vector<std::string> names;            // without the unit
  std::vector<std::vector<double>> columns;  // [names.size()][rows]

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  // Throws InputError when there is no such column.
  [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const;
};

// Throws InputError for a file that cannot be read or a line that does not fit the header.
CsvTable read_csv(const std::filesystem::path& path);

// The first column as the text that it is.
std::vector<std::string> read_csv_names(const std::filesystem::path& path);

// Value of y at x by linear interpolation between the rows around x, where xs increases; NaN
// outside.
double interpolate(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace verification

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
  // Opens a table with columns "name[unit]", "[-]" when dimensionless. Throws ComputationError when
  // the file cannot be written.
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);

  // Continues a table with these columns after its first `length` bytes; the rest is dropped.
  // Throws InputError when the file is shorter or has other columns.
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
            std::uintmax_t length);

  // Writes one row in the order of the columns without delay, so that an interrupted run keeps its
  // finished steps. Throws ComputationError when writing fails.
  void row(const std::vector<double>& values);
  // Bytes written so far, header included.
  [[nodiscard]] std::uintmax_t length() const { return file_.length(); }
  [[nodiscard]] std::filesystem::path path() const { return file_.path(); }

 private:
  GrowingFile file_;
  std::size_t columns_;
};

// Replaces a whole table atomically. Throws ComputationError.
void write_csv(const std::filesystem::path& path, const std::vector<std::string>& columns,
               const std::vector<std::vector<double>>& rows);

struct CsvTable {
  std::vector<std::string> names;            // without the unit
  std::vector<std::vector<double>> columns;  // [names.size()][rows]; NaN: no number
  std::vector<std::string> units{};          // of the header, "" for a column that has none

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  [[nodiscard]] bool has(std::string_view name) const;
  // Column of this name. Throws InputError when there is none.
  [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const;
};

// Reads a table. Throws InputError for an unreadable file or a row that does not fit the header.
CsvTable read_csv(const std::filesystem::path& path);

// Texts of the first column.
std::vector<std::string> read_csv_names(const std::filesystem::path& path);

// y at x by linear interpolation between rows with increasing xs; NaN outside.
double interpolate(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace verification

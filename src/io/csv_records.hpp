// Comma-separated values (RFC 4180), record by record.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace grainlaw::core {

// Fields in quotes may have commas, line breaks and doubled quotes in them.
class CsvRecords {
 public:
  // The text must outlive it.
  explicit CsvRecords(std::string_view text) : rest_(text) {}

  // The fields of the next record; false at the end. An empty line is a record of one empty field.
  bool next(std::vector<std::string>& fields);

  // Of the last record: the line that it begins in, and whether a quote in it was left open.
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] bool open() const { return open_; }

 private:
  std::string_view rest_;
  std::size_t line_ = 1, next_line_ = 1;
  bool open_ = false;
};

}  // namespace grainlaw::core

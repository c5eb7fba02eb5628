// Comma-separated values (RFC 4180), read and written record by record.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace grainlaw::core {

// Reader of records; quoted fields may contain commas, line breaks and doubled quotes.
class CsvRecords {
 public:
  // `text` must outlive the reader.
  explicit CsvRecords(std::string_view text) : rest_(text) {}

  // Reads the fields of the next record; false at the end. An empty line is a record of one empty
  // field.
  bool next(std::vector<std::string>& fields);

  // First line of the last record, and whether it left a quote open.
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] bool open() const { return open_; }

 private:
  std::string_view rest_;
  std::size_t line_ = 1, next_line_ = 1;
  bool open_ = false;
};

// A field as text, quoted where necessary.
std::string csv_field(std::string_view text);

// A record as a line.
std::string csv_record(const std::vector<std::string>& fields);

}  // namespace grainlaw::core

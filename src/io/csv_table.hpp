// Reader of a comma-separated file by column names. Numbers are exact to the bit, and errors name
// file and line.
#pragma once

#include "base/error.hpp"
#include "io/csv_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace grainlaw::core {

// Rows of the wanted columns. Throws Error: FILE_ERROR when the file cannot be opened, BAD_PACKING
// for wrong content.
template <std::size_t columns>
class CsvTable {
 public:
  // `path` names the file in messages. A name may have a unit, "x[m]": headers may have it too, and
  // no other.
  CsvTable(const std::string& path, std::string_view text,
           const std::array<std::string_view, columns>& names)
      : path_(path), text_(text), records_(text_) {
    for (std::size_t column = 0; column < columns; ++column)
      std::tie(names_[column], units_[column]) = parted(names[column]);
    if (text_.find('\0') != std::string::npos)
      throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}: not a text file", path));
    if (!read_record()) fail("the file is empty, expected a header line");
    header_ = shortened(text_.substr(0, text_.find_first_of("\r\n")));
    width_ = fields_.size();
    index_.fill(none);
    for (std::size_t k = 0; k < width_; ++k)
      for (std::size_t column = 0; column < columns; ++column) {
        const auto [name, unit] = parted(fields_[k]);
        if (name != names_[column]) continue;
        if (index_[column] != none) fail(fmt::format("column '{}' stands twice", name));
        if (!unit.empty() && unit != units_[column])
          fail(
              fmt::format("column '{}': found the unit [{}], expected {}; grainlaw import brings "
                          "others to SI",
                          name, unit, units_[column].empty() ? "none" : units_[column]));
        index_[column] = k;
      }
  }

  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  [[nodiscard]] bool has(std::size_t column) const { return index_[column] != none; }

  // Fails unless the columns first..last-1 are present.
  void require(std::size_t first, std::size_t last) const {
    for (std::size_t k = first; k < last; ++k)
      if (!has(k))
        fail(fmt::format("the header has no column '{}'; found '{}'", names_[k], header_));
  }

  // Reads the next non-blank line; false at the end.
  bool next() {
    if (!read_record()) return false;
    if (fields_.size() < width_) fail("fewer fields than the header has columns");
    if (fields_.size() > width_) fail("more fields than the header has columns");
    return true;
  }

  // Text of a column; empty where the file lacks the column.
  [[nodiscard]] std::string_view text(std::size_t column) const {
    return has(column) ? std::string_view(fields_[index_[column]]) : std::string_view();
  }

  // A finite number.
  [[nodiscard]] double real(std::size_t column) const {
    double value = 0;
    if (!parse(column, value) || !std::isfinite(value)) complain(column, "a finite number");
    return value;
  }

  [[nodiscard]] double positive(std::size_t column) const {
    const double value = real(column);
    if (!(value > 0)) complain(column, "a number > 0");
    return value;
  }

  [[nodiscard]] std::int64_t integer(std::size_t column) const {
    std::int64_t value = 0;
    if (!parse(column, value)) complain(column, "an integer");
    return value;
  }

  [[noreturn]] void complain(std::size_t column, std::string_view expected) const {
    fail(fmt::format("column '{}': found '{}', expected {}", names_[column], text(column),
                     expected));
  }

  [[noreturn]] void fail(std::string_view message) const {
    throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}:{}: {}", path_, line(), message));
  }

  [[nodiscard]] std::size_t line() const { return records_.line(); }

 private:
  static constexpr auto none = static_cast<std::size_t>(-1);

  // Splits "x [m]" into its name and its unit.
  static std::pair<std::string_view, std::string_view> parted(std::string_view name) {
    const auto bracket = name.find('[');
    if (bracket == std::string_view::npos || !name.ends_with(']')) return {name, {}};
    const std::string_view unit = name.substr(bracket + 1, name.size() - bracket - 2);
    return {name.substr(0, name.find_last_not_of(" \t", bracket - 1) + 1), unit};
  }

  // Line cut to the length of a message.
  static std::string shortened(std::string line) {
    constexpr std::size_t longest = 120;
    for (char& letter : line)
      if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
    return line.size() > longest ? line.substr(0, longest) + "..." : line;
  }

  // Reads the next non-blank record and trims its fields; false at the end.
  bool read_record() {
    constexpr std::string_view blanks = " \t";
    do {
      if (!records_.next(fields_)) return false;
      if (records_.open()) fail("a quote is not closed");
      for (std::string& field : fields_) {
        field.erase(0, std::min(field.size(), field.find_first_not_of(blanks)));
        field.erase(field.find_last_not_of(blanks) + 1);
      }
    } while (fields_.size() == 1 && fields_.front().empty());
    return true;
  }

  template <class T>
  bool parse(std::size_t column, T& value) const {
    const std::string_view field = text(column);
    const char* end = field.data() + field.size();
    const auto [stop, error] = std::from_chars(field.data(), end, value);
    return error == std::errc{} && stop == end && !field.empty();
  }

  std::string path_;
  std::array<std::string_view, columns> names_, units_;
  std::string text_;
  CsvRecords records_;
  std::vector<std::string> fields_;
  std::array<std::size_t, columns> index_{};  // index of each column in a record
  std::size_t width_ = 0;
  std::string header_;  // header line for messages
};

}  // namespace grainlaw::core

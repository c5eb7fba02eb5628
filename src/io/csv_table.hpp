// A comma-separated file read line by line: wanted columns by name, numbers exact to the bit,
// errors with file and line.
#pragma once

#include "base/error.hpp"
#include "io/text_file.hpp"

#include <csv.h>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>

namespace grainlaw {

// Throws Error: FILE_ERROR when the file cannot be opened, BAD_PACKING for what is wrong in it.
template <std::size_t columns>
class CsvTable {
 public:
  // path is the file's name in messages.
  CsvTable(const std::string& path, std::string_view text,
           const std::array<const char*, columns>& names)
      : path_(path),
        names_(names),
        content_(checked(path, text)),
        header_(first_line(content_)),
        reader_(path, content_.data(), content_.data() + content_.size()) {
    translate([&] {
      std::apply(
          [&](auto... name) {
            reader_.read_header(io::ignore_extra_column | io::ignore_missing_column, name...);
          },
          names_);
    });
  }

  [[nodiscard]] bool has(std::size_t column) const { return reader_.has_column(names_[column]); }

  // Columns first..last-1 must be there.
  void require(std::size_t first, std::size_t last) const {
    for (std::size_t k = first; k < last; ++k)
      if (!has(k))
        fail(fmt::format("the header has no column '{}'; found '{}'", names_[k], header_));
  }

  // Read the next line that is not blank; false at the end.
  bool next() {
    bool more = false;
    translate(
        [&] { more = std::apply([&](auto&... text) { return reader_.read_row(text...); }, row_); });
    return more;
  }

  [[nodiscard]] std::string_view text(std::size_t column) const { return row_[column]; }

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

  [[nodiscard]] unsigned line() const { return reader_.get_file_line(); }

 private:
  using Reader =
      io::CSVReader<columns, io::trim_chars<' ', '\t'>, io::double_quote_escape<',', '"'>,
                    io::throw_on_overflow, io::empty_line_comment>;

  // Ends in a line break: the reader looks one byte past the last line.
  static std::string checked(const std::string& path, std::string_view found) {
    std::string text(found);
    if (text.find('\0') != std::string::npos)
      throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}: not a text file", path));
    if (!text.empty() && text.back() != '\n') text += '\n';
    return text;
  }

  // As much of it as a message has room for.
  static std::string first_line(std::string_view text) {
    constexpr std::size_t longest = 120;
    std::string line(text.substr(0, text.find_first_of("\r\n")));
    for (char& letter : line)
      if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
    return line.size() > longest ? line.substr(0, longest) + "..." : line;
  }

  template <class T>
  bool parse(std::size_t column, T& value) const {
    const std::string_view field = text(column);
    const char* end = field.data() + field.size();
    const auto [stop, error] = std::from_chars(field.data(), end, value);
    return error == std::errc{} && stop == end && !field.empty();
  }

  template <class Action>
  void translate(Action&& action) const {
    try {
      action();
    } catch (const io::error::header_missing&) {
      fail("the file is empty, expected a header line");
    } catch (const io::error::too_few_columns&) {
      fail("fewer fields than the header has columns");
    } catch (const io::error::too_many_columns&) {
      fail("more fields than the header has columns");
    } catch (const io::error::base& e) {
      fail(e.what());
    }
  }

  std::string path_;
  std::array<const char*, columns> names_;
  std::array<const char*, columns> row_{};
  std::string content_;
  std::string header_;  // for messages
  Reader reader_;
};

}  // namespace grainlaw

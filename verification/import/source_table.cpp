#include "import/source_table.hpp"

#include "app/library.hpp"
#include "io/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace verification {
namespace {

std::string found_separator(std::string_view line) {
  for (const char* one : {";", ","})
    if (line.find(one) != std::string_view::npos) return one;
  return " ";
}

bool all_numbers(const std::vector<std::string_view>& row) {
  return std::all_of(row.begin(), row.end(),
                     [](std::string_view field) { return number_in(field).has_value(); });
}

// What YADE says in its first line: "#format x_y_z_r_matId".
std::vector<std::string> format_names(std::string_view format) {
  std::vector<std::string> names;
  for (const std::string_view part : fields(format, "_"))
    if (part != "attrs") names.push_back(plain_name(part));
  return names;
}

// Comment lines and the first line tell what the columns are.
class PlainReader {
 public:
  PlainReader(SourceTable& table, std::string separator)
      : table_(table), separator_(std::move(separator)) {}

  void read() {
    Lines lines(*table_.text);
    while (lines.next()) {
      if (lines.text().empty()) continue;
      if (const auto hash = lines.text().find('#');
          lines.text().front() == '#' || (table_.rows.empty() && is_attribute_line(lines.text()))) {
        comment(lines.text().substr(hash), lines.number());
        continue;
      }
      if (separator_.empty()) separator_ = found_separator(lines.text());
      row(fields(lines.text(), separator_), lines.number());
    }
    if (table_.rows.empty())
      table_.fail("found no line of numbers, expected one for each particle or contact");
    take_names();
    if (table_.kind.empty())
      table_.kind = table_.names.empty() ? "a table without header" : "a table with header";
  }

 private:
  // YADE puts the comment of x_y_z_r_attrs before the hash.
  [[nodiscard]] bool is_attribute_line(std::string_view line) const {
    return !format_.empty() && line.find("# x y z r") != std::string_view::npos;
  }

  void comment(std::string_view line, std::size_t number) {
    const std::vector<std::string_view> parts = words(line);
    const auto numbers = [&](std::size_t count) {
      if (parts.size() != count + 1)
        table_.fail(number, fmt::format("found {} words after {}, expected {} lengths",
                                        parts.size() - 1, parts[0], count));
      std::vector<double> values;
      for (std::size_t k = 1; k <= count; ++k) {
        const auto value = number_in(parts[k]);
        if (!value)
          table_.fail(number,
                      fmt::format("column {}: found '{}', expected a length", k + 1, parts[k]));
        values.push_back(*value);
      }
      return values;
    };
    if (parts.front() == "#format" && parts.size() > 1) {
      format_ = format_names(parts[1]);
      table_.kind = fmt::format("a text export of YADE, format {}", parts[1]);
    } else if (parts[0] == "##PERIODIC::") {
      const std::vector<double> l = numbers(3);
      if (!table_.cell) table_.cell = Lattice{l[0], 0, 0, 0, l[1], 0, 0, 0, l[2]};
      if (table_.kind.empty()) table_.kind = "a sphere pack of YADE";
      pack_ = true;
    } else if (parts[0] == "##CELL::") {
      const std::vector<double> h = numbers(9);
      table_.cell.emplace();
      std::copy(h.begin(), h.end(), table_.cell->begin());
    } else {
      line.remove_prefix(1);
      comment_ = names_in(fields(line, found_separator(line)));
    }
  }

  void row(std::vector<std::string_view> one, std::size_t line) {
    if (table_.rows.empty() && names_line_ == 0 && !all_numbers(one)) {
      const bool any = std::any_of(one.begin(), one.end(), [](std::string_view field) {
        return number_in(field).has_value();
      });
      if (!any) {
        table_.take_names(names_in(one));
        names_line_ = line;
        return;
      }
    }
    const std::size_t expected = names_line_ > 0       ? table_.names.size()
                                 : table_.rows.empty() ? one.size()
                                                       : table_.rows.front().size();
    if (one.size() != expected)
      table_.fail(line,
                  fmt::format("found {} fields, expected {} as in line {}", one.size(), expected,
                              names_line_ > 0 ? names_line_ : table_.lines.front()));
    table_.rows.push_back(std::move(one));
    table_.lines.push_back(line);
  }

  void take_names() {
    const std::size_t width = table_.rows.front().size();
    if (!table_.names.empty()) return;
    if (!format_.empty()) {
      table_.names = format_;
      for (std::size_t k = table_.names.size(); k < width; ++k)
        table_.names.push_back(k < comment_.size() ? plain_name(comment_[k])
                                                   : fmt::format("column {}", k + 1));
      if (table_.names.size() != width)
        table_.fail(table_.lines.front(),
                    fmt::format("found {} fields, expected those of the format, {}", width,
                                fmt::join(format_, " ")));
    } else if (pack_ && width == 5) {
      table_.names = {"x", "y", "z", "r", "clump"};
    } else if (comment_.size() == width && !all_numbers(comment_)) {
      table_.take_names(comment_);
    }
  }

  SourceTable& table_;
  std::string separator_;
  std::vector<std::string> format_;
  std::vector<std::string_view> comment_;  // the last one before the numbers
  std::size_t names_line_ = 0;
  bool pack_ = false;
};

// Both the file and the command line may say what they are, but not two things.
void take_units(SourceTable& table, const FileUnits& told) {
  const auto take = [&](double& unit, double of_option, const char* option) {
    if (of_option > 0 && unit > 0 && of_option != unit)
      table.fail(fmt::format("found the units '{}' and another {}, expected one of them",
                             table.units.name, option));
    if (of_option > 0) unit = of_option;
  };
  take(table.units.length, told.length, "--length-unit");
  take(table.units.force, told.force, "--force-unit");
}

}  // namespace

void SourceTable::fail(std::size_t line, std::string_view message) const {
  throw InputError(fmt::format("{}:{}: {}", path, line, message));
}

void SourceTable::fail(std::string_view message) const {
  throw InputError(fmt::format("{}: {}", path, message));
}

void SourceTable::take_names(const std::vector<std::string_view>& fields) {
  names.clear();
  column_units.clear();
  for (const std::string_view field : fields) {
    names.push_back(plain_name(field));
    column_units.push_back(unit_of_name(field));
  }
}

double SourceTable::unit(Quantity quantity) const {
  if (const auto in_si = units.of(quantity)) return *in_si;
  fail(
      fmt::format("found the units '{}', which are none of SI, expected --length-unit, and "
                  "--force-unit and --density where there are such",
                  units.name));
}

SourceTable read_source(const std::string& path, const std::string& separator,
                        const FileUnits& told) {
  SourceTable table;
  table.path = path;
  table.text = std::make_shared<const std::string>(
      as<InputError>([&] { return grainlaw::core::read_text(path); }));
  if (table.text->find('\0') != std::string::npos)
    table.fail(
        "found bytes that are no text, expected a table, a text export of YADE, or a dump or "
        "data file of LAMMPS as text");
  if (is_lammps_dump(*table.text))
    read_lammps_dump(table);
  else if (is_lammps_data(*table.text))
    read_lammps_data(table);
  else
    PlainReader(table, separator).read();
  take_units(table, told);
  return table;
}

}  // namespace verification

// Tables of numbers as other programs write them: any separator, with or without a header; dumps and
// data files of LAMMPS; text exports of YADE. Errors name file, line and column.
#pragma once

#include "import/unit.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

using Position = std::array<double, 3>;
using Lattice = std::array<double, 9>;  // H row by row, lattice vectors are its columns [m]

// Which column stands for what: "x" -> "pos_x" (a name of the header) or "3" (the third).
using ColumnChoice = std::map<std::string, std::string>;

struct SourceTable {
  std::string path;
  std::string kind;                         // for a person, "LAMMPS dump, step 100"
  std::shared_ptr<const std::string> text;  // that the rows point into
  std::vector<std::string>
      names;  // of the columns, in small letters without units; empty: no header
  std::vector<std::string> column_units;  // that the header has in brackets, or ""; or empty
  std::vector<std::vector<std::string_view>> rows;
  std::vector<std::size_t> lines;  // of the rows
  std::optional<Lattice> cell;     // that the file tells, in its units
  Position origin{};               // of that cell
  FileUnits units;
  bool lammps = false;
  std::optional<long> step;        // of LAMMPS
  std::vector<std::string> notes;  // what a person should know of it

  // Names with their units in brackets.
  void take_names(const std::vector<std::string_view>& fields);
  // What a number without a unit of its own is in SI. Throws where nobody says.
  [[nodiscard]] double unit(Quantity quantity) const;
  [[noreturn]] void fail(std::size_t line, std::string_view message) const;
  [[noreturn]] void fail(std::string_view message) const;
};

// `separator`: "" finds it: a semicolon, a comma, else blanks. `told`: units of the command line.
// Throws InputError.
SourceTable read_source(const std::string& path, const std::string& separator,
                        const FileUnits& told);

// "x=1,y=2,r=rad". Throws InputError with the name of the option.
ColumnChoice read_choice(const std::string& option, const std::string& text);

// Columns of a table under the names that this program has for them, in SI.
class Columns {
 public:
  Columns(const SourceTable& table, ColumnChoice choice);

  // Finds the column as chosen, else by one of the names that other programs have for it. In a
  // table without a header it is, failing both, the one at this place (1, 2, ...; 0: nowhere).
  void find(const std::string& name, const std::vector<std::string>& others,
            Quantity quantity = Quantity::number, std::size_t index = 0);
  [[nodiscard]] bool has(const std::string& name) const { return found_.contains(name); }
  // Throws for the first of them that was not found.
  void require(const std::vector<std::string>& names) const;
  // Every choice has to be of a column that somebody looked for.
  void close(const std::string& option) const;

  [[nodiscard]] double real(std::size_t row, const std::string& name) const;
  [[nodiscard]] double positive(std::size_t row, const std::string& name) const;
  [[nodiscard]] long integer(std::size_t row, const std::string& name) const;
  // "x, y, r (columns 2, 3, 5)"
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] std::string_view field(std::size_t row, const std::string& name) const;
  [[noreturn]] void complain(std::size_t row, const std::string& name,
                             std::string_view expected) const;

  struct Found {
    std::size_t index = 0;
    double unit = 1;  // in SI
  };
  // In SI, of its header, else of its file.
  [[nodiscard]] double unit(const std::string& name, std::size_t index, Quantity quantity) const;

  const SourceTable& table_;
  ColumnChoice choice_;
  std::map<std::string, Found> found_;
  std::vector<std::string> order_, wanted_;
};

// A whole field as a finite number; nothing when it is something else.
std::optional<double> number_in(std::string_view field);

// "rad [m]" and "\"Radius\"" as "rad" and "radius"; and the units, "m" and "".
std::string plain_name(std::string_view field);
std::string unit_of_name(std::string_view field);

// Files of LAMMPS say what they are.
bool is_lammps_dump(std::string_view text);
bool is_lammps_data(std::string_view text);
void read_lammps_dump(SourceTable& table);
void read_lammps_data(SourceTable& table);

// One line after the other of a text.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool next();  // false at the end
  [[nodiscard]] std::string_view text() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view rest_, line_;
  std::size_t number_ = 0;
};

// The words of a line between blanks; or the fields between separators, without blanks and quotes.
std::vector<std::string_view> words(std::string_view line);
std::vector<std::string_view> fields(std::string_view line, const std::string& separator);
// Words of a header, each with the unit that blanks part from it: "x [mm] y [mm]".
std::vector<std::string_view> names_in(const std::vector<std::string_view>& words);

}  // namespace verification

// Tables for people and for programs.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace verification {

// A table, printed to stdout and written as CSV.
class Table {
 public:
  struct Cell {
    Cell(double number);
    Cell(std::string text) : shown(text), full(std::move(text)) {}
    Cell(const char* text) : shown(text), full(text) {}
    std::string shown;  // number with four digits
    std::string full;   // number with ten digits
  };

  // Columns are "name[unit]".
  Table(std::string title, std::vector<std::string> columns);

  void row(const std::vector<Cell>& cells);
  // Prints the title and aligned rows.
  void print() const;
  // Writes the table as CSV. Throws ComputationError when it cannot.
  void write(const std::filesystem::path& path) const;

 private:
  std::string title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace verification

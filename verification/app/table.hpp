// Tables for people and for programs.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace verification {

// A table that is printed to stdout and written as CSV.
class Table {
 public:
  struct Cell {
    Cell(double number);
    Cell(std::string text) : shown(text), full(std::move(text)) {}
    Cell(const char* text) : shown(text), full(text) {}
    std::string shown;  // four digits of a number
    std::string full;   // ten
  };

  // Columns as "name[unit]".
  Table(std::string title, std::vector<std::string> columns);

  void row(const std::vector<Cell>& cells);
  // Prints title and rows in columns.
  void print() const;
  // Throws ComputationError when the file cannot be written.
  void write(const std::filesystem::path& path) const;

 private:
  std::string title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace verification

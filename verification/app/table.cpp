#include "app/table.hpp"

#include "app/atomic_file.hpp"
#include "io/csv_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace verification {

Table::Cell::Cell(double number)
    : shown(fmt::format("{:.4g}", number)), full(fmt::format("{:.10g}", number)) {}

Table::Table(std::string title, std::vector<std::string> columns)
    : title_(std::move(title)), columns_(std::move(columns)) {}

void Table::row(const std::vector<Cell>& cells) {
  if (cells.size() != columns_.size()) throw std::logic_error("table: a row of another length");
  rows_.push_back(cells);
}

void Table::print() const {
  std::vector<std::size_t> width;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    width.push_back(columns_[k].size());
    for (const auto& row : rows_) width[k] = std::max(width[k], row[k].shown.size());
  }
  fmt::print("\n{}\n", title_);
  for (std::size_t k = 0; k < columns_.size(); ++k) fmt::print("  {:>{}}", columns_[k], width[k]);
  fmt::print("\n");
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) fmt::print("  {:>{}}", row[k].shown, width[k]);
    fmt::print("\n");
  }
}

void Table::write(const std::filesystem::path& path) const {
  std::filesystem::create_directories(path.has_parent_path() ? path.parent_path() : ".");
  std::string text = grainlaw::core::csv_record(columns_);
  for (const auto& row : rows_) {
    std::vector<std::string> fields;
    for (const Cell& cell : row) {
      fields.push_back(cell.full);
      std::replace(fields.back().begin(), fields.back().end(), ',', ';');  // keeps it one field
    }
    text += grainlaw::core::csv_record(fields);
  }
  write_file(path, text);
}

}  // namespace verification

// Energies of a dynamic run as a table.
#pragma once

#include "app/csv.hpp"
#include "fe/solver/solver.hpp"

#include <filesystem>
#include <optional>

namespace verification {

// Writes STEM_energy.csv, a row per step, from the first step on that has energies.
class EnergyHistory {
 public:
  explicit EnergyHistory(std::filesystem::path stem) : stem_(std::move(stem)) {}
  void add(const LoadStep& step);

 private:
  std::filesystem::path stem_;
  std::optional<CsvWriter> csv_;
};

}  // namespace verification

// Displacement histories of chosen places.
#pragma once

#include "app/csv.hpp"
#include "fe/solver/solver.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace verification {

struct DisplacementProbe {
  std::string name;
  std::vector<int> nodes;
};

// Mean displacement over the nodes [m].
Eigen::Vector2d mean_displacement(const DisplacementProbe& probe, const Eigen::VectorXd& displacement);

// Writes STEM_probes.csv, a row per step, two columns per probe; nothing without probes.
class ProbeHistory {
 public:
  ProbeHistory(const std::filesystem::path& stem, std::vector<DisplacementProbe> probes);
  void add(const LoadStep& step, const Eigen::VectorXd& displacement);

 private:
  std::vector<DisplacementProbe> probes_;
  std::optional<CsvWriter> csv_;
};

}  // namespace verification

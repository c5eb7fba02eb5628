// Displacement histories of chosen places.
#pragma once

#include "fe/solver/solver.hpp"

#include <string>
#include <vector>

namespace verification {

struct DisplacementProbe {
  std::string name;
  std::vector<int> nodes;
};

// Mean displacement over the nodes [m].
Eigen::Vector2d mean_displacement(const DisplacementProbe& probe,
                                  const Eigen::VectorXd& displacement);

// A row of their table: step, time of the run, and two components for every probe.
std::vector<std::string> probe_columns(const std::vector<DisplacementProbe>& probes);
std::vector<double> probe_values(const std::vector<DisplacementProbe>& probes, const LoadStep& step,
                                 const Eigen::VectorXd& displacement);

}  // namespace verification

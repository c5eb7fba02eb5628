// Displacement histories at chosen places.
#pragma once

#include "fe/solver/solver.hpp"

#include <string>
#include <vector>

namespace verification {

struct DisplacementProbe {
  std::string name;
  std::vector<int> nodes;
};

// Mean displacement of the nodes [m].
Eigen::Vector2d mean_displacement(const DisplacementProbe& probe,
                                  const Eigen::VectorXd& displacement);

// Columns of the probes' table: step, time, and two components per probe.
std::vector<std::string> probe_columns(const std::vector<DisplacementProbe>& probes);
std::vector<double> probe_values(const std::vector<DisplacementProbe>& probes, const LoadStep& step,
                                 const Eigen::VectorXd& displacement);

}  // namespace verification

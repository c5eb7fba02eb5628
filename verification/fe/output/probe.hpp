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
Position mean_displacement(const DisplacementProbe& probe, const Mesh& mesh,
                           const Eigen::VectorXd& displacement);

// Columns of the probes' table: step, time, and the components of every probe.
std::vector<std::string> probe_columns(const std::vector<DisplacementProbe>& probes, int dimension);
std::vector<double> probe_values(const std::vector<DisplacementProbe>& probes, const Mesh& mesh,
                                 const LoadStep& step, const Eigen::VectorXd& displacement);

}  // namespace verification

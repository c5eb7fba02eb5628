#include "fe/output/probe.hpp"

#include <fmt/format.h>

namespace verification {

Position mean_displacement(const DisplacementProbe& probe, const Mesh& mesh,
                           const Eigen::VectorXd& displacement) {
  Position sum = Position::Zero(mesh.dimension());
  for (const int node : probe.nodes) sum += mesh.moved(node, displacement);
  return sum / static_cast<double>(probe.nodes.size());
}

std::vector<std::string> probe_columns(const std::vector<DisplacementProbe>& probes,
                                       int dimension) {
  std::vector<std::string> columns{"step[-]", "time[s]"};
  for (const DisplacementProbe& probe : probes)
    for (const std::string_view component : component_names(dimension))
      columns.push_back(fmt::format("{}_{}[m]", probe.name, component));
  return columns;
}

std::vector<double> probe_values(const std::vector<DisplacementProbe>& probes, const Mesh& mesh,
                                 const LoadStep& step, const Eigen::VectorXd& displacement) {
  std::vector<double> values{static_cast<double>(step.record.step), step.time};
  for (const DisplacementProbe& probe : probes) {
    const Position mean = mean_displacement(probe, mesh, displacement);
    values.insert(values.end(), mean.begin(), mean.end());
  }
  return values;
}

}  // namespace verification

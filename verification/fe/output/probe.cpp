#include "fe/output/probe.hpp"

namespace verification {

Eigen::Vector2d mean_displacement(const DisplacementProbe& probe,
                                  const Eigen::VectorXd& displacement) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const int node : probe.nodes) sum += displacement.segment<2>(2 * node);
  return sum / static_cast<double>(probe.nodes.size());
}

std::vector<std::string> probe_columns(const std::vector<DisplacementProbe>& probes) {
  std::vector<std::string> columns{"step[-]", "time[s]"};
  for (const DisplacementProbe& probe : probes)
    for (const char* component : {"_x[m]", "_y[m]"}) columns.push_back(probe.name + component);
  return columns;
}

std::vector<double> probe_values(const std::vector<DisplacementProbe>& probes, const LoadStep& step,
                                 const Eigen::VectorXd& displacement) {
  std::vector<double> values{static_cast<double>(step.record.step), step.time};
  for (const DisplacementProbe& probe : probes) {
    const Eigen::Vector2d mean = mean_displacement(probe, displacement);
    values.insert(values.end(), {mean.x(), mean.y()});
  }
  return values;
}

}  // namespace verification

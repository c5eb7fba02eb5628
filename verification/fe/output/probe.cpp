#include "fe/output/probe.hpp"

namespace verification {

Eigen::Vector2d mean_displacement(const DisplacementProbe& probe, const Eigen::VectorXd& displacement) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const int node : probe.nodes) sum += displacement.segment<2>(2 * node);
  return sum / static_cast<double>(probe.nodes.size());
}

ProbeHistory::ProbeHistory(const std::filesystem::path& stem, std::vector<DisplacementProbe> probes)
    : probes_(std::move(probes)) {
  if (probes_.empty()) return;
  std::vector<std::string> columns{"step[-]", "time"};
  for (const DisplacementProbe& probe : probes_) {
    columns.push_back(probe.name + "_x[m]");
    columns.push_back(probe.name + "_y[m]");
  }
  csv_.emplace(stem.string() + "_probes.csv", columns);
}

void ProbeHistory::add(const LoadStep& step, const Eigen::VectorXd& displacement) {
  if (!csv_) return;
  std::vector<double> row{static_cast<double>(step.record.step), step.time};
  for (const DisplacementProbe& probe : probes_) {
    const Eigen::Vector2d mean = mean_displacement(probe, displacement);
    row.insert(row.end(), {mean.x(), mean.y()});
  }
  csv_->row(row);
}

}  // namespace verification

#include "fe/conditions/monitors.hpp"

#include "fe/model.hpp"

#include <algorithm>

namespace verification {

std::vector<Monitor> make_monitors(const Model& model) {
  std::vector<Monitor> monitors;
  const auto known = [&](const std::string& name) {
    return std::any_of(monitors.begin(), monitors.end(),
                       [&](const Monitor& monitor) { return monitor.name == name; });
  };
  for (const PrescribedDisplacement& condition : model.displacements)
    monitors.push_back({condition.name, condition.nodes, condition.component});
  for (const Tie& tie : model.ties) {
    Monitor monitor{tie.set + '_' + component_name(tie.component), tie.nodes, tie.component};
    if (known(monitor.name)) continue;  // a platen that is prescribed
    for (std::size_t k = 0; k < model.resultants.size(); ++k)
      if (model.resultants[k].set == tie.set && model.resultants[k].component == tie.component)
        monitor.resultant = static_cast<int>(k);
    monitors.push_back(monitor);
  }
  for (const Periodic& periodic : model.periodics)
    for (const int i : {0, 1}) {
      Monitor monitor{periodic.name + '_' + component_name(i), {}, i};
      for (const auto& pair : periodic.pairs) monitor.nodes.push_back(pair.second);
      monitor.from = periodic.pairs.front().first;
      monitors.push_back(monitor);
    }
  return monitors;
}

Monitored monitored(const Monitor& monitor, const Model& model, double time,
                    const Eigen::VectorXd& displacement, const Eigen::VectorXd& imbalance) {
  const auto at = [&](int node) { return 2 * node + monitor.component; };
  Monitored result{displacement(at(monitor.nodes.front())), 0};
  if (monitor.from >= 0) result.displacement -= displacement(at(monitor.from));
  for (const int node : monitor.nodes) result.force -= imbalance(at(node));
  if (monitor.resultant >= 0)
    result.force += model.resultants[static_cast<std::size_t>(monitor.resultant)].value.at(time);
  return result;
}

}  // namespace verification

#include "fe/conditions/monitors.hpp"

#include "fe/model.hpp"

#include <algorithm>

namespace verification {
namespace {

Weights sum_of(const std::vector<int>& nodes) {
  Weights weights;
  for (const int node : nodes) weights.emplace_back(node, 1.0);
  return weights;
}

double sum(const Weights& weights, const Mesh& mesh, const Eigen::VectorXd& field, int component) {
  double result = 0;
  for (const auto& [node, weight] : weights) result += weight * field(mesh.dof(node, component));
  return result;
}

Monitor monitor_angle(const Tie& tie) {
  Monitor monitor{tie.set + "_hinge", tie.component, angle_weights(tie), {}, -1, true};
  for (std::size_t k = 0; k < tie.nodes.size(); ++k)
    monitor.force.emplace_back(tie.nodes[k], tie.arms[k]);
  return monitor;
}

}  // namespace

std::vector<Monitor> make_monitors(const Model& model) {
  std::vector<Monitor> monitors;
  const auto known = [&](const std::string& name) {
    return std::find_if(monitors.begin(), monitors.end(),
                        [&](const Monitor& monitor) { return monitor.name == name; });
  };
  for (const PrescribedDisplacement& condition : model.displacements)
    monitors.push_back({condition.name,
                        condition.component,
                        {{condition.nodes.front(), 1.0}},
                        sum_of(condition.nodes)});
  for (const Tie& tie : model.ties) {
    Monitor monitor{tie.set + '_' + component_name(tie.component), tie.component,
                    hinge_weights(tie), sum_of(tie.nodes)};
    for (std::size_t k = 0; k < model.resultants.size(); ++k)
      if (model.resultants[k].set == tie.set && model.resultants[k].component == tie.component)
        monitor.resultant = static_cast<int>(k);
    if (const auto prescribed = known(monitor.name); prescribed == monitors.end())
      monitors.push_back(monitor);
    else
      prescribed->motion = monitor.motion;
    if (!tie.arms.empty()) monitors.push_back(monitor_angle(tie));
  }
  for (const Periodic& periodic : model.periodics)
    for (int i = 0; i < model.mesh.dimension(); ++i) {
      const auto& [first, second] = periodic.pairs.front();
      Monitor monitor{
          periodic.name + '_' + component_name(i), i, {{second, 1.0}, {first, -1.0}}, {}};
      for (const auto& pair : periodic.pairs) monitor.force.emplace_back(pair.second, 1.0);
      monitors.push_back(monitor);
    }
  return monitors;
}

const char* force_unit(int dimension) { return dimension == 2 ? "N/m" : "N"; }

std::array<std::string, 2> columns(const Monitor& monitor, int dimension) {
  if (monitor.angle) return {monitor.name + "_angle[rad]", monitor.name + "_moment[N]"};
  return {monitor.name + "_displacement[m]",
          monitor.name + "_force[" + force_unit(dimension) + "]"};
}

Monitored monitored(const Monitor& monitor, const Model& model, double time,
                    const Eigen::VectorXd& displacement, const Eigen::VectorXd& imbalance) {
  Monitored result{sum(monitor.motion, model.mesh, displacement, monitor.component),
                   -sum(monitor.force, model.mesh, imbalance, monitor.component)};
  if (monitor.resultant >= 0)
    result.force += model.resultants[static_cast<std::size_t>(monitor.resultant)].value.at(time);
  return result;
}

}  // namespace verification

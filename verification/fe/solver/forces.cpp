#include "fe/solver/forces.hpp"

#include "fe/conditions/monitors.hpp"

namespace verification {

void add_external_force(const Model& model, double time, const Eigen::VectorXd& displacement,
                        Eigen::VectorXd& force, Triplets* stiffness) {
  add_loads(model.loads, time, model.mesh, displacement, force, stiffness);
  for (const Resultant& resultant : model.resultants)
    for (const auto& [node, weight] : resultant.nodes)
      force(model.mesh.dof(node, resultant.component)) += weight * resultant.value.at(time);
}

void report_supports(const Model& model, double time, const Eigen::VectorXd& displacement,
                     const Eigen::VectorXd& imbalance, LoadStep& step) {
  for (const Monitor& monitor : make_monitors(model)) {
    const Monitored found = monitored(monitor, model, time, displacement, imbalance);
    step.displacements.push_back(found.displacement);
    step.reactions.push_back(found.force);
  }
}

}  // namespace verification

#include "fe/solver/forces.hpp"

namespace verification {

void add_external_force(const Model& model, double time, const Eigen::VectorXd& displacement,
                        Eigen::VectorXd& force, Triplets* stiffness) {
  add_loads(model.loads, time, model.mesh, displacement, force, stiffness);
}

void report_supports(const Model& model, double time, const Eigen::VectorXd& imbalance,
                     LoadStep& step) {
  for (const PrescribedDisplacement& condition : model.displacements) {
    step.displacements.push_back(condition.value.at(time));
    step.reactions.push_back(0);
    for (const int node : condition.nodes)
      step.reactions.back() -= imbalance(2 * node + condition.component);
  }
}

}  // namespace verification

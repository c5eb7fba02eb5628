#include "fe/conditions/conditions.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <numeric>

namespace verification {

Eigen::VectorXd Dofs::expand(const Eigen::VectorXd& reduced) const {
  Eigen::VectorXd full = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t d = 0; d < unknown.size(); ++d)
    if (unknown[d] >= 0) full(static_cast<Eigen::Index>(d)) = reduced(unknown[d]);
  return full;
}

Eigen::VectorXd Dofs::reduce(const Eigen::VectorXd& full) const {
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t d = 0; d < unknown.size(); ++d)
    if (unknown[d] >= 0) reduced(unknown[d]) += full(static_cast<Eigen::Index>(d));
  return reduced;
}

Eigen::VectorXd Dofs::prescribed_at(double time) const {
  Eigen::VectorXd full = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t d = 0; d < unknown.size(); ++d)
    if (program[d] >= 0)
      full(static_cast<Eigen::Index>(d)) = programs[static_cast<std::size_t>(program[d])].at(time);
  return full;
}

Dofs number_dofs(std::size_t nodes, const std::vector<PrescribedDisplacement>& displacements,
                 const std::vector<Tie>& ties) {
  constexpr int free = -2;
  Dofs dofs;
  dofs.unknown.assign(2 * nodes, free);
  dofs.program.assign(2 * nodes, -1);
  const auto dof = [](int node, int component) {
    return static_cast<std::size_t>(2 * node + component);
  };
  for (const PrescribedDisplacement& condition : displacements) {
    for (const int node : condition.nodes) {
      dofs.unknown[dof(node, condition.component)] = -1;
      dofs.program[dof(node, condition.component)] = static_cast<int>(dofs.programs.size());
    }
    dofs.programs.push_back(condition.value);
  }
  std::vector<std::size_t> leader(2 * nodes);
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  std::vector<bool> tied(2 * nodes, false);
  for (const Tie& tie : ties)
    for (const int node : tie.nodes) {
      const std::size_t d = dof(node, tie.component);
      if (tied[d] || dofs.unknown[d] == -1)
        throw InputError(fmt::format(
            "tie: component {} of node {} is prescribed or belongs to another tie already",
            tie.component == 0 ? "x" : "y", node + 1));
      tied[d] = true;
      leader[d] = dof(tie.nodes.front(), tie.component);
    }
  for (std::size_t d = 0; d < dofs.unknown.size(); ++d) {
    if (dofs.unknown[d] == -1) continue;
    int& number = dofs.unknown[leader[d]];
    if (number == free) number = dofs.unknowns++;
    dofs.unknown[d] = number;
  }
  return dofs;
}

}  // namespace verification

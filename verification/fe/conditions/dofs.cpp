#include "fe/conditions/dofs.hpp"

#include "app/library.hpp"
#include "fe/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace verification {

Eigen::VectorXd Dofs::expand(const Eigen::VectorXd& reduced) const {
  Eigen::VectorXd full = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t d = 0; d < unknown.size(); ++d)
    follow(d, [&](int k, double factor) {
      full(static_cast<Eigen::Index>(d)) += factor * reduced(k);
    });
  return full;
}

Eigen::VectorXd Dofs::reduce(const Eigen::VectorXd& full) const {
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t d = 0; d < unknown.size(); ++d)
    follow(d, [&](int k, double factor) {
      reduced(k) += factor * full(static_cast<Eigen::Index>(d));
    });
  return reduced;
}

Eigen::VectorXd Dofs::reduce_mass(const Eigen::VectorXd& full) const {
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t d = 0; d < unknown.size(); ++d)
    follow(d, [&](int k, double factor) {
      reduced(k) += factor * factor * full(static_cast<Eigen::Index>(d));
    });
  return reduced;
}

bool Dofs::masses_coupled(const Eigen::VectorXd& full) const {
  std::vector<double> coupling(static_cast<std::size_t>(unknowns)), size = coupling;
  for (std::size_t d = 0; d < unknown.size(); ++d) {
    if (platen_rotation[d].angle < 0 || unknown[d] < 0) continue;
    const double product = full(static_cast<Eigen::Index>(d)) * platen_rotation[d].arm;
    coupling[static_cast<std::size_t>(platen_rotation[d].angle)] += product;
    size[static_cast<std::size_t>(platen_rotation[d].angle)] += std::abs(product);
  }
  constexpr double round_off = 1e-9;
  for (std::size_t k = 0; k < coupling.size(); ++k)
    if (std::abs(coupling[k]) > round_off * size[k]) return true;
  return false;
}

Eigen::VectorXd Dofs::prescribed_at(double time) const {
  std::vector<double> values;
  for (const Program& program : programs) values.push_back(program.at(time));
  Eigen::VectorXd full = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown.size()));
  for (const auto& [dof, program, factor] : prescribed) full(dof) += factor * values[program];
  return full;
}

namespace {

[[noreturn]] void refuse(const std::string& place, int node, int component,
                         const std::string& found, const std::string& expected) {
  throw InputError(fmt::format("{}: found component {} of node {} {}, expected {}", place,
                               component_name(component), node + 1, found, expected));
}

// Links all conditions, one kind after the other.
class Linker {
 public:
  Linker(const Model& model, std::vector<Program>& programs)
      : mesh_(model.mesh),
        regularisation_(static_cast<std::size_t>(mesh_.dofs())),
        prescribed_by_(regularisation_, nullptr),
        tied_by_(regularisation_, nullptr),
        linkage_(regularisation_, programs) {
    // Collects all programs first, since the linkage refers to them.
    for (const auto& condition : model.displacements) programs.push_back(condition.value);
    for (const auto& condition : model.periodics)
      for (const auto& jump : condition.jump)
        if (jump) programs.push_back(*jump);
    for (const auto& condition : model.displacements) prescribe(condition);
    for (const auto& condition : model.ties) tie(condition);
    for (const auto& condition : model.periodics) repeat(condition);
  }

  [[nodiscard]] const Linkage& linkage() const { return linkage_; }
  [[nodiscard]] std::size_t regularise() const { return regularisation_; }

 private:
  void prescribe(const PrescribedDisplacement& condition) {
    for (const int node : condition.nodes) {
      const std::size_t d = dof(node, condition.component);
      if (!linkage_.link(d, regularisation_, {{next_program_, 1}}))
        refuse(condition.place, node, condition.component,
               fmt::format("prescribed otherwise by {}", prescribed_by_[d]->place),
               "one value for it");
      prescribed_by_[d] = &condition;
    }
    ++next_program_;
  }

  void tie(const Tie& tie) {
    for (const int node : tie.nodes) {
      const std::size_t d = dof(node, tie.component);
      if (tied_by_[d] != nullptr)
        refuse(tie.place, node, tie.component,
               fmt::format("bound by {} already", tied_by_[d]->place), "one tie or platen for it");
      tied_by_[d] = &tie;
      // A platen without rotation follows the condition on any of its nodes.
      const PrescribedDisplacement* other = prescribed_by_[d];
      const bool follows = tie.platen && (tie.arms.empty() || (other && other->set == tie.set));
      if (other != nullptr && !follows)
        refuse(tie.place, node, tie.component,
               fmt::format("both bound and prescribed by {}", other->place),
               tie.platen ? "the whole platen prescribed, by its own set" : "one of them");
      if (!linkage_.link(d, dof(tie.nodes.front(), tie.component), {}))
        refuse(tie.place, node, tie.component, "bound to move otherwise", "one motion for it");
    }
  }

  void repeat(const Periodic& periodic) {
    for (int i = 0; i < mesh_.dimension(); ++i) {
      for (const auto& pair : periodic.pairs)
        for (const int node : {pair.first, pair.second}) {
          const Tie* other = tied_by_[dof(node, i)];
          if (other != nullptr && !other->arms.empty())
            refuse(periodic.place, node, i, fmt::format("on a platen that turns, {}", other->place),
                   "no periodic sides across it");
        }
      const bool jumps = periodic.jump[static_cast<std::size_t>(i)].has_value();
      const Offset offset = jumps ? Offset{{next_program_++, 1}} : Offset{};
      for (const auto& [first, second] : periodic.pairs) {
        const auto* one = prescribed_by_[dof(first, i)];
        const auto* other = prescribed_by_[dof(second, i)];
        if ((one == nullptr) != (other == nullptr))
          refuse(periodic.place, one != nullptr ? first : second, i,
                 fmt::format("prescribed on one side by {}", (one != nullptr ? one : other)->place),
                 "both nodes of a periodic pair prescribed, or neither");
        if (!linkage_.link(dof(second, i), dof(first, i), offset))
          refuse(periodic.place, second, i,
                 fmt::format("bound to differ otherwise from that of node {}", first + 1),
                 "a jump that agrees with the other conditions");
      }
    }
  }

  [[nodiscard]] std::size_t dof(int node, int component) const {
    return static_cast<std::size_t>(mesh_.dof(node, component));
  }

  const Mesh& mesh_;
  std::size_t regularisation_;
  std::vector<const PrescribedDisplacement*> prescribed_by_;
  std::vector<const Tie*> tied_by_;
  Linkage linkage_;
  std::size_t next_program_ = 0;
};

// Place in the scene of the first condition that is not 0 at time 0.
std::string moved_at_start(const Model& model) {
  for (const PrescribedDisplacement& displacement : model.displacements)
    if (displacement.value.at(0) != 0) return displacement.place;
  for (const Periodic& periodic : model.periodics)
    for (const std::optional<Program>& jump : periodic.jump)
      if (jump && jump->at(0) != 0) return periodic.place;
  return {};
}

}  // namespace

Dofs number_dofs(const Model& model) {
  Dofs dofs;
  const Linker linker(model, dofs.programs);
  const std::size_t ground = linker.regularise();
  std::vector<int> number(ground, -1);  // number of each root
  for (std::size_t d = 0; d < ground; ++d) {
    const auto [root, offset] = linker.linkage().find(d);
    if (root != ground && number[root] < 0) number[root] = dofs.unknowns++;
    dofs.unknown.push_back(root == ground ? -1 : number[root]);
    for (const auto& [program, factor] : offset)
      dofs.prescribed.push_back({static_cast<int>(d), program, factor});
  }
  dofs.platen_rotation.resize(ground);
  for (const Tie& tie : model.ties) {
    if (tie.arms.empty()) continue;
    for (std::size_t k = 0; k < tie.nodes.size(); ++k)
      dofs.platen_rotation[static_cast<std::size_t>(model.mesh.dof(tie.nodes[k], tie.component))] =
          {dofs.unknowns, tie.arms[k]};
    ++dofs.unknowns;
  }
  if (dofs.prescribed_at(0).any())
    throw InputError(
        fmt::format("{}: found a displacement or jump that is not 0 at time 0, expected 0 there: a "
                    "run starts at F = I",
                    moved_at_start(model)));
  return dofs;
}

void check_loads_act(const Model& model, const Dofs& dofs) {
  const Eigen::VectorXd at_rest =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(dofs.unknown.size()));
  const auto check = [&](const Loads& one, const std::string& place) {
    Eigen::VectorXd force = at_rest;
    add_loads(one, 0, model.mesh, at_rest, force, nullptr);
    constexpr double round_off = 1e-9;
    if (dofs.reduce(force).norm() <= round_off * force.norm())
      throw InputError(
          place +
          ": found displacements prescribed wherever the load acts, expected some that "
          "it can move");
  };
  const Program unit = Program::linear(1, 1);
  for (Pressure pressure : model.loads.pressures) {
    pressure.value = unit;
    check({{pressure}, {}}, pressure.place);
  }
  for (Traction traction : model.loads.tractions) {
    traction.value = unit;
    check({{}, {traction}}, traction.place);
  }
}

}  // namespace verification

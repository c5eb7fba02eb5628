#include "fe/conditions/conditions_scene.hpp"

#include "fe/conditions/program_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification {
namespace {

template <class Sets>
std::vector<std::string_view> names(const Sets& sets) {
  std::vector<std::string_view> result;
  for (const auto& entry : sets) result.push_back(entry.first);
  return result;
}

// Name of a set of the mesh.
template <class Sets>
std::string read_set(SceneTable& table, const Sets& sets) {
  const std::string set = table.text("on");
  if (sets.empty())
    table.fail("on", '"' + set + '"', "a mesh with sets: the physical groups of its file are none");
  return table.choice_or("on", set, names(sets));
}

int read_component(SceneTable& table, const Model& model) {
  const std::string component = table.text("component");
  return table.choice_or("component", component, component_names(model.mesh.dimension()))[0] - 'x';
}

void read_displacement(SceneTable& table, double duration, Model& model) {
  PrescribedDisplacement condition;
  condition.set = read_set(table, model.mesh.node_sets);
  condition.nodes = model.mesh.node_sets[condition.set];
  condition.component = read_component(table, model);
  condition.name = condition.set + '_' + component_name(condition.component);
  condition.value = read_program(table, duration, Rise::from_zero);
  condition.place = table.place();
  table.close();
  for (const PrescribedDisplacement& other : model.displacements)
    if (other.name == condition.name)
      table.fail("on", fmt::format("{} once more, after {}", condition.name, other.place),
                 "every component of a set prescribed once");
  model.displacements.push_back(condition);
}

void read_tie(SceneTable& table, Model& model) {
  const std::string set = read_set(table, model.mesh.node_sets);
  const int component = read_component(table, model);
  table.close();
  model.ties.push_back({model.mesh.node_sets[set], component, set, table.place(), false});
}

// Axis along which the nodes do not extend; -1: none.
int normal_component(const Mesh& mesh, const std::vector<int>& nodes) {
  Position low = mesh.position(nodes.front()), high = low;
  for (const int node : nodes) {
    low = low.cwiseMin(mesh.position(node));
    high = high.cwiseMax(mesh.position(node));
  }
  const Position extent = high - low;
  constexpr double flat = 1e-9;
  for (int i = 0; i < mesh.dimension(); ++i)
    if (extent(i) <= flat * extent.maxCoeff()) return i;
  return -1;
}

// Arms of the nodes about the hinge, by default the middle of the platen.
std::vector<double> read_arms(SceneTable& table, const Mesh& mesh, const std::vector<int>& nodes,
                              int normal) {
  const int along = 1 - normal;
  const auto position = [&](int node) { return mesh.position(node)(along); };
  const auto [low, high] = std::minmax_element(
      nodes.begin(), nodes.end(), [&](int a, int b) { return position(a) < position(b); });
  if (!(position(*high) > position(*low)))
    table.fail("rotation", "a platen on one node", "two nodes at least");
  const double hinge =
      table.number_or("hinge", 0.5 * (position(*low) + position(*high)), any_number);
  const double sign = normal == 1 ? 1 : -1;
  std::vector<double> arms;
  for (const int node : nodes) arms.push_back(sign * (position(node) - hinge));
  return arms;
}

void read_platen(SceneTable& table, Model& model) {
  const std::string set = read_set(table, model.mesh.node_sets);
  const bool rough = table.choice_or("surface", "smooth", {"smooth", "rough"}) == "rough";
  const bool rotates = table.choice_or("rotation", "fixed", {"fixed", "free"}) == "free";
  const std::vector<int>& nodes = model.mesh.node_sets[set];
  const int normal = normal_component(model.mesh, nodes);
  if (normal < 0)
    table.fail("on", fmt::format("the bent or inclined set {}", set),
               model.mesh.dimension() == 2 ? "a straight side along x or y"
                                           : "a flat side across x, y or z");
  if (rotates && model.mesh.dimension() == 3)
    table.fail("rotation", "\"free\" of a body of spheres", "\"fixed\"");
  std::vector<double> arms;
  if (rotates) arms = read_arms(table, model.mesh, nodes, normal);
  if (!rotates && table.has("hinge"))
    table.fail("hinge", "a platen that does not turn", "rotation = \"free\" beside it");
  table.close();
  for (int i = 0; i < model.mesh.dimension(); ++i)
    if (rough || i == normal)
      model.ties.push_back(
          {nodes, i, set, table.place(), true, i == normal ? arms : std::vector<double>{}});
}

// Partners of the first set's nodes in the second, all shifted by one vector.
std::vector<std::pair<int, int>> match(SceneTable& table, const Mesh& mesh,
                                       const std::vector<int>& first,
                                       const std::vector<int>& second) {
  const std::string expected = "two sides whose nodes differ by one shift";
  if (first.size() != second.size())
    table.fail("sides", fmt::format("{} and {} nodes", first.size(), second.size()), expected);
  Position shift = Position::Zero(mesh.dimension());
  for (std::size_t k = 0; k < first.size(); ++k)
    shift += mesh.position(second[k]) - mesh.position(first[k]);
  shift /= static_cast<double>(first.size());
  constexpr double close = 1e-6;  // relative to the shift
  std::vector<std::pair<int, int>> pairs;
  for (const int node : first) {
    const auto partner = std::find_if(second.begin(), second.end(), [&](int other) {
      return (mesh.position(node) + shift - mesh.position(other)).norm() <= close * shift.norm();
    });
    if (partner == second.end() || *partner == node)
      table.fail("sides", fmt::format("node {} without a partner", node + 1), expected);
    pairs.emplace_back(node, *partner);
  }
  return pairs;
}

void read_periodic(SceneTable& table, double duration, Model& model) {
  const toml::node* node = table.node("sides");
  std::array<std::string, 2> sides;
  const auto& sets = model.mesh.node_sets;
  const std::string expected = fmt::format("two of {}", fmt::join(names(sets), ", "));
  const toml::array* array = node != nullptr ? node->as_array() : nullptr;
  if (array == nullptr || array->size() != 2) table.fail("sides", "something else", expected);
  for (std::size_t k = 0; k < 2; ++k) {
    sides[k] = (*array)[k].value_or(std::string());
    if (!sets.contains(sides[k])) table.fail("sides", '"' + sides[k] + '"', expected);
  }
  Periodic periodic;
  periodic.pairs = match(table, model.mesh, sets.at(sides[0]), sets.at(sides[1]));
  periodic.name = sides[0] + '_' + sides[1];
  periodic.place = table.place();
  for (int i = 0; i < model.mesh.dimension(); ++i) {
    const std::string key = fmt::format("jump_{}", component_name(i));
    if (!table.has(key)) continue;
    SceneTable jump = table.table(key);
    periodic.jump[static_cast<std::size_t>(i)] = read_program(jump, duration, Rise::from_zero);
    jump.close();
  }
  table.close();
  model.periodics.push_back(periodic);
}

void read_resultant(SceneTable& table, double duration, Model& model) {
  Resultant resultant;
  resultant.set = read_set(table, model.mesh.node_sets);
  resultant.component = read_component(table, model);
  resultant.value = read_program(table, duration, Rise::from_zero);
  resultant.place = table.place();
  table.close();
  const std::string name = resultant.set + '_' + component_name(resultant.component);
  const auto same = [&](const auto& other) {
    return other.set == resultant.set && other.component == resultant.component;
  };
  const auto tie = std::find_if(model.ties.begin(), model.ties.end(), same);
  if (tie == model.ties.end())
    table.fail("on", fmt::format("{}, whose nodes move each for themselves", name),
               "a set that a [[tie]] or [[platen]] binds in this component");
  for (const auto& other : model.displacements)
    if (same(other))
      table.fail("on", fmt::format("{}, which is prescribed by {}", name, other.place),
                 "either the displacement or the force of a platen");
  if (std::any_of(model.resultants.begin(), model.resultants.end(), same))
    table.fail("on", fmt::format("{} once more", name), "one resultant for it");
  resultant.nodes = hinge_weights(*tie);
  model.resultants.push_back(resultant);
}

void read_pressure(SceneTable& table, double duration, Model& model) {
  Pressure pressure;
  pressure.place = table.place();
  pressure.sides = model.mesh.side_sets[read_set(table, model.mesh.side_sets)];
  pressure.value = read_program(table, duration, Rise::none);
  pressure.follows = table.choice_or("kind", "follower", {"follower", "dead"}) == "follower";
  table.close();
  model.loads.pressures.push_back(pressure);
}

void read_traction(SceneTable& table, double duration, Model& model) {
  Traction traction;
  traction.place = table.place();
  traction.sides = model.mesh.side_sets[read_set(table, model.mesh.side_sets)];
  traction.component = read_component(table, model);
  traction.value = read_program(table, duration, Rise::from_zero);
  table.close();
  model.loads.tractions.push_back(traction);
}

}  // namespace

void read_conditions(SceneTable& scene, double duration, Model& model) {
  for (SceneTable& table : scene.tables("displacement")) read_displacement(table, duration, model);
  for (SceneTable& table : scene.tables("tie")) read_tie(table, model);
  for (SceneTable& table : scene.tables("platen")) read_platen(table, model);
  for (SceneTable& table : scene.tables("periodic")) read_periodic(table, duration, model);
  for (SceneTable& table : scene.tables("resultant")) read_resultant(table, duration, model);
  for (SceneTable& table : scene.tables("pressure")) read_pressure(table, duration, model);
  for (SceneTable& table : scene.tables("traction")) read_traction(table, duration, model);
}

}  // namespace verification

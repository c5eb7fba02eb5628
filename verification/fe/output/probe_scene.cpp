#include "fe/output/probe_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace verification {
namespace {

std::vector<int> nodes_at(SceneTable& table, std::string_view key, const Mesh& mesh) {
  const int axis = key[0] - 'x';
  const double coordinate = table.number(key);
  double nearest = mesh.nodes.front()(axis), low = nearest, high = nearest;
  for (const Position& node : mesh.nodes) {
    low = std::min(low, node(axis));
    high = std::max(high, node(axis));
    if (std::abs(node(axis) - coordinate) < std::abs(nearest - coordinate)) nearest = node(axis);
  }
  const double tolerance = 1e-6 * (high - low);
  if (std::abs(nearest - coordinate) > tolerance)
    table.fail(key, fmt::format("{} m, where no node lies", coordinate),
               fmt::format("a line or plane of nodes, e.g. {} = {:.9g}", key, nearest));
  std::vector<int> nodes;
  for (std::size_t k = 0; k < mesh.nodes.size(); ++k)
    if (std::abs(mesh.nodes[k](axis) - nearest) <= tolerance) nodes.push_back(static_cast<int>(k));
  return nodes;
}

}  // namespace

DisplacementProbe read_probe(SceneTable& table, const Mesh& mesh) {
  DisplacementProbe probe;
  probe.name = table.file_name("name");
  std::string_view where;
  std::vector<std::string_view> keys = component_names(mesh.dimension());
  keys.insert(keys.begin(), "on");
  const std::string all = fmt::format("{}", fmt::join(keys, ", "));
  for (const std::string_view key : keys) {
    if (!table.has(key)) continue;
    if (!where.empty()) table.fail(key, fmt::format("{} too", where), "one of " + all);
    where = key;
  }
  if (where.empty())
    table.fail("on", "nothing", "one of " + all + ": a set of nodes, or a coordinate [m]");
  if (where == "on") {
    std::vector<std::string_view> sets;
    for (const auto& [name, nodes] : mesh.node_sets) sets.push_back(name);
    const std::string set = table.text("on");
    probe.nodes = mesh.node_sets.at(table.choice_or("on", set, sets));
  } else {
    probe.nodes = nodes_at(table, where, mesh);
  }
  table.close();
  return probe;
}

}  // namespace verification

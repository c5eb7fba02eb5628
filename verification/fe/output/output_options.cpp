#include "fe/output/output_options.hpp"

#include "fe/output/cost_report.hpp"
#include "fe/output/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

// Reads an increasing list of distinct integers in 0..last.
std::vector<int> read_integers(SceneTable& table, std::string_view key, int last,
                               std::string_view expected) {
  std::vector<int> result;
  const toml::node* node = table.node(key);
  if (node == nullptr) return result;
  const toml::array* list = node->as_array();
  if (list == nullptr) table.fail(key, "no list", expected);
  for (const toml::node& entry : *list) {
    const auto value = entry.is_integer() ? entry.value<std::int64_t>() : std::nullopt;
    if (!value || *value < 0 || *value > last)
      table.fail(key, value ? fmt::format("{}", *value) : "another type", expected);
    result.push_back(static_cast<int>(*value));
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<std::size_t> read_points(SceneTable& table, std::string_view key, std::size_t points) {
  const std::vector<int> read =
      read_integers(table, key, static_cast<int>(points) - 1,
                    fmt::format("a list of integration points, 0 to {}", points - 1));
  return {read.begin(), read.end()};
}

// Reads fields, or names beside them.
std::vector<std::string> read_fields(SceneTable& table, std::string_view key, int dimension,
                                     std::vector<std::string> names = {}) {
  for (const Field& candidate : fields(dimension))
    if (candidate.components == 1) names.emplace_back(candidate.name);
  const std::string expected = fmt::format("a list of {}", fmt::join(names, ", "));
  std::vector<std::string> result;
  const toml::node* node = table.node(key);
  if (node == nullptr) return result;
  const toml::array* list = node->as_array();
  if (list == nullptr) table.fail(key, "no list", expected);
  for (const toml::node& entry : *list) {
    const auto name = entry.value<std::string>().value_or("another type");
    if (std::find(names.begin(), names.end(), name) == names.end()) table.fail(key, name, expected);
    if (std::find(result.begin(), result.end(), name) == result.end()) result.push_back(name);
  }
  return result;
}

}  // namespace

OutputOptions read_output(SceneTable& scene, const Mesh& mesh, int steps) {
  const std::size_t points = mesh.elements.size() * element_type(mesh.kind).points.size();
  OutputOptions options;
  options.checkpoint_every = scene.integer_or("checkpoint_every", 0, 0);
  options.vtk_every = scene.integer_or("vtk_every", 0, 0);
  options.packings = read_points(scene, "packings", points);
  if (!options.packings.empty() && options.vtk_every == 0)
    scene.fail("vtk_every", "0", "how often the packings are written, a number of load steps >= 1");
  options.points = read_points(scene, "points", points);
  options.every_point = read_fields(scene, "every_point", mesh.dimension(), {point_cost});
  options.point_costs = std::erase(options.every_point, point_cost) > 0;
  if (!scene.has("picture")) return options;
  SceneTable table = scene.table("picture");
  options.pictures.fields = read_fields(table, "fields", mesh.dimension());
  options.pictures.extremes = read_fields(table, "extremes", mesh.dimension());
  options.pictures.packings = read_points(table, "packings", points);
  options.pictures.steps = table.has("steps")
                               ? read_integers(table, "steps", steps,
                                               fmt::format("a list of load steps, 0 to {}", steps))
                               : std::vector<int>{steps};
  table.close();
  return options;
}

}  // namespace verification

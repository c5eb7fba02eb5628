#include "wave/scene.hpp"

#include "app/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace verification {
namespace {

std::size_t length_of(SceneTable& table, std::string_view key, std::string_view expected) {
  const toml::node* node = table.node(key);
  if (node == nullptr || !node->is_array()) table.fail(key, "nothing or another type", expected);
  return node->as_array()->size();
}

std::vector<int> read_divisions(SceneTable& table) {
  constexpr const char* expected = "whole numbers of elements, 1 to 10000";
  std::vector<int> divisions;
  for (const double value :
       table.numbers("divisions", length_of(table, "divisions", expected), positive)) {
    if (value != std::floor(value) || value > 1e4)
      table.fail("divisions", fmt::format("{}", value), expected);
    divisions.push_back(static_cast<int>(value));
  }
  return divisions;
}

WaveCase read_case(SceneTable table, const std::string& name) {
  WaveCase one;
  one.name = table.file_name_or("name", name);
  one.material = read_material_source(table);
  one.repeat = static_cast<std::size_t>(table.integer("repeat", 1));
  one.duration = table.number("duration", positive);
  one.time_step = table.number("time_step", positive);
  one.rows = static_cast<std::size_t>(table.integer_or("rows", 400, 1));
  one.sections = table.numbers(
      "sections", length_of(table, "sections", "distances from the right end [m]"), not_negative);
  one.agitation_damping = table.number_or("agitation_damping", 0, not_negative);
  one.threads = table.integer_or("threads", 0, 0);
  SceneTable pulse = table.table("pulse");
  one.pulse.amplitude = pulse.number("amplitude", positive);
  one.pulse.period = pulse.number("period", positive);
  pulse.close();
  for (SceneTable& window : table.tables("window")) {
    const double from = window.number("from", not_negative), to = window.number("to", positive);
    if (to <= from) window.fail("to", fmt::format("{}", to), fmt::format("more than {}", from));
    window.close();
    one.windows.push_back({from, to});
  }
  if (table.has("mesh")) {
    SceneTable mesh = table.table("mesh");
    one.divisions = read_divisions(mesh);
    one.mesh_time_step = mesh.number("time_step", positive);
    mesh.close();
  }
  table.close();
  return one;
}

}  // namespace

double Pulse::at(double time) const {
  if (time <= 0 || time >= 0.5 * period) return 0;
  return amplitude * std::sin(2 * std::numbers::pi * time / period);
}

WaveScene read_wave_scene(const SceneFile& file) {
  SceneTable root = file.root();
  WaveScene scene;
  scene.name = root.file_name_or("name", file.path.stem().string());
  const std::vector<toml::table> cases = scene_cases(file);
  if (cases.empty()) scene.cases.push_back(read_case(root, scene.name));
  for (const toml::table& one : cases)
    scene.cases.push_back(read_case({one, file.path, ""}, scene.name));
  return scene;
}

}  // namespace verification

#include "app/text.hpp"
#include "dns/scene.hpp"
#include "fe/scene.hpp"
#include "keys/keys.hpp"
#include "point/scene.hpp"
#include "wave/scene.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>

namespace verification {
namespace {

using Reader = std::function<void(const SceneFile&)>;

// Beginning of every example.
constexpr std::string_view discs = "material = { dimension = 2 }\n";
constexpr std::string_view spheres = "material = { dimension = 3 }\n";
constexpr std::string_view point = R"(
[[segment]]
steps = 1
)";
constexpr std::string_view free_stretch = R"(
[[segment]]
steps = 1
F11 = "free"
mean_pressure = 1
)";
constexpr std::string_view box = R"(
steps = 1
mesh = { size = [1, 1, 1], divisions = [1, 1, 1] }
[[periodic]]
sides = ["left", "right"]
jump_z = { value = 1 }
[[probe]]
name = "middle"
z = 0
)";
constexpr std::string_view rectangle = R"(
steps = 1
vtk_every = 1
newton = {}
mesh = { size = [1, 1], divisions = [2, 2], average_length = 1 }
[[prestress.segment]]
steps = 1
[[displacement]]
on = "left"
component = "x"
value = 0
[[displacement]]
on = "bottom"
component = "y"
path = [[0, 0], [1, 1]]
[[tie]]
on = "right"
component = "x"
[[resultant]]
on = "right"
component = "x"
half_sine = { amplitude = 1, period = 1 }
[[platen]]
on = "top"
rotation = "free"
[[pressure]]
on = "top"
value = 1
[[traction]]
on = "top"
component = "y"
sine = { amplitude = 1, period = 1 }
[[probe]]
name = "middle"
on = "top"
[picture]
)";
constexpr std::string_view driven = R"(
steps = 1
solver = "relaxation"
mesh = { size = [1, 1], divisions = [1, 1] }
relaxation = {}
cycle = { on = "top", step = 1, limit_force = 1, cycles = 1 }
[[periodic]]
sides = ["left", "right"]
jump_x = { value = 1 }
jump_y = { value = 1 }
)";
constexpr std::string_view dynamics = R"(
steps = 1
solver = "dynamics"
mesh = { size = [1, 1], divisions = [1, 1] }
dynamics = { duration = 1, density = 1 }
)";
constexpr std::string_view specimen = R"(
repeat = [1, 1]
sides = {}
start = { sigma11 = -1 }
[[segment]]
steps = 1
)";
constexpr std::string_view pulse = R"(
repeat = 1
duration = 1
time_step = 1
sections = [1]
pulse = { amplitude = 1, period = 1 }
mesh = { divisions = [1], time_step = 1 }
[[window]]
from = 0
to = 1
)";

struct Examples {
  Reader read;
  std::vector<std::string> texts;
};

Examples examples_of(std::string_view command) {
  const auto with = [](std::string_view first, std::string_view rest) {
    return std::string(first) + std::string(rest);
  };
  if (command == "point")
    return {[](const SceneFile& file) { static_cast<void>(read_point_scenes(file)); },
            {with(discs, point), with(spheres, point), with(discs, free_stretch)}};
  if (command == "solve")
    return {
        [](const SceneFile& file) { static_cast<void>(read_fe_scene(file)); },
        {with(discs, rectangle), with(discs, driven), with(discs, dynamics), with(spheres, box)}};
  if (command == "dns")
    return {[](const SceneFile& file) { static_cast<void>(read_specimen_scenes(file)); },
            {with(discs, specimen)}};
  if (command == "wave")
    return {[](const SceneFile& file) { static_cast<void>(read_wave_scene(file)); },
            {with(discs, pulse)}};
  throw InputError(
      fmt::format("keys: found {}, expected one of material, point, solve, dns, wave, columns, "
                  "balance, measures, statuses",
                  command));
}

}  // namespace

std::vector<Key> scene_keys(std::string_view command) {
  const Examples examples = examples_of(command);
  grainlaw::core::KeyLog log;
  for (const std::string& text : examples.texts) {
    SceneFile file("example.toml", grainlaw::core::parse_toml(text, "example.toml"));
    file.log = &log;
    try {
      examples.read(file);
    } catch (const InputError&) {
      // Conflicts are reported after the keys were asked for, and ignored.
    }
  }
  std::vector<Key> keys;
  for (const grainlaw::core::AskedKey& key : log)
    if (key.expected != "a table") keys.push_back({key, "", ""});
  return keys;
}

}  // namespace verification

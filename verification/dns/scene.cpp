#include "dns/scene.hpp"

#include "app/cases.hpp"
#include "app/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace verification {
namespace {

constexpr std::array<const char*, 4> indices{"11", "12", "21", "22"};
using Kind = SpecimenTarget::Kind;

// Default rules: left and right flexible under a uniform stress; bottom and top smooth, moved along
// y by F.
toml::table default_sides() {
  const toml::table flexible{{"x", "T"}, {"y", "T"}};
  const toml::table platen{{"x", "T"}, {"y", "D"}};
  return toml::table{{"left", flexible}, {"right", flexible}, {"bottom", platen}, {"top", platen}};
}

std::array<std::optional<double>, 4> read_start(SceneTable table) {
  std::array<std::optional<double>, 4> stress;
  bool any = false;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string name = std::string("sigma") + indices[k];
    if (!table.has(name)) continue;
    stress[k] = table.number(name);
    any = true;
  }
  if (!any) table.fail("sigma11", "nothing", "at least one component of the stress [Pa]");
  table.close();
  return stress;
}

SpecimenTarget read_target(SceneTable& segment, std::size_t k) {
  struct Key {
    const char* prefix;
    Kind kind;
  };
  constexpr std::array<Key, 3> keys{
      {{"F", Kind::deformation}, {"stretch", Kind::stretch}, {"P", Kind::stress}}};
  SpecimenTarget target;
  std::string given;
  for (const Key& key : keys) {
    const std::string name = std::string(key.prefix) + indices[k];
    const toml::node* node = segment.node(name);
    if (node == nullptr) continue;
    if (!given.empty())
      segment.fail(name, "a second condition beside " + given, "one condition per component");
    given = name;
    if (key.kind == Kind::stretch && k != 0 && k != 3)
      segment.fail(name, "a stretch off the diagonal", "stretch11 or stretch22");
    if (key.kind == Kind::stress && node->is_string()) {
      segment.choice_or(name, "held", {"held"});
      target.kind = Kind::keep_stress;
      continue;
    }
    target.kind = key.kind;
    target.value =
        key.kind == Kind::stretch ? segment.number(name, positive) : segment.number(name);
  }
  return target;
}

SpecimenScene read_scene(SceneTable table, const std::string& name) {
  SpecimenScene scene;
  scene.name = table.file_name_or("name", name);
  scene.material = read_material_source(table);
  constexpr Range counts{1, 100, false, "an integer from 1 to 100"};
  const std::vector<double> repeat = table.numbers("repeat", 2, counts);
  for (const double value : repeat)
    if (value != static_cast<int>(value))
      table.fail("repeat", fmt::format("{}", value), counts.text);
  scene.repeat = {static_cast<int>(repeat[0]), static_cast<int>(repeat[1])};
  scene.sides = default_sides();
  if (table.has("sides")) {
    SceneTable sides = table.table("sides");
    for (const char* side : {"left", "right", "bottom", "top"})
      if (sides.has(side)) scene.sides.insert_or_assign(side, sides.table(side).content());
    sides.close();
  }
  if (table.has("start")) scene.start = read_start(table.table("start"));
  for (SceneTable& entry : table.tables("segment")) {
    SpecimenSegment segment;
    segment.steps = entry.integer("steps", 1);
    for (std::size_t k = 0; k < 4; ++k) segment.target[k] = read_target(entry, k);
    entry.close();
    scene.segments.push_back(segment);
  }
  if (scene.segments.empty()) table.fail("segment", "nothing", "at least one [[segment]]");
  scene.max_cuts = table.integer_or("max_cuts", scene.max_cuts, 0, most_cuts);
  scene.may_end = table.flag_or("may_end", false);
  scene.vtk_every = table.integer_or("vtk_every", 0, 0);
  scene.picture_force = table.number_or("picture_force", 0, not_negative);
  if (const toml::node* node = table.node("pictures")) {
    const toml::array* list = node->as_array();
    scene.pictures = table.numbers("pictures", list != nullptr ? list->size() : 1, any_number);
    std::sort(scene.pictures.begin(), scene.pictures.end());
  }
  table.close();
  return scene;
}

}  // namespace

std::vector<SpecimenScene> read_specimen_scenes(const SceneFile& file) {
  const std::string stem = file.path.stem().string();
  const std::vector<toml::table> cases = scene_cases(file);
  if (cases.empty()) return {read_scene(file.root(), stem)};
  std::vector<SpecimenScene> scenes;
  for (const toml::table& content : cases)
    scenes.push_back(read_scene({content, file.path, ""}, stem));
  return scenes;
}

}  // namespace verification

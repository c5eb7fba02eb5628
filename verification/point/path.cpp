#include "point/path.hpp"

#include <fmt/format.h>

namespace verification {
namespace {

constexpr std::array<const char*, 4> indices{"11", "12", "21", "22"};

Target read_target(SceneTable& segment, const char* index) {
  struct Key {
    const char* prefix;
    Target target;
  };
  constexpr std::array<Key, 4> keys{{{"F", {Control::deformation, false, 0}},
                                     {"dF", {Control::deformation, true, 0}},
                                     {"P", {Control::piola, false, 0}},
                                     {"sigma", {Control::cauchy, false, 0}}}};
  Target target;
  std::string given;
  for (const Key& key : keys) {
    const std::string name = std::string(key.prefix) + index;
    if (segment.node(name) == nullptr) continue;
    if (!given.empty())
      segment.fail(name, "a second condition beside " + given, "one condition per component");
    target = key.target;
    target.value = segment.number(name);
    given = name;
  }
  return target;
}

}  // namespace

std::vector<Segment> read_segments(SceneTable& scene) {
  std::vector<Segment> segments;
  for (SceneTable& table : scene.tables("segment")) {
    Segment segment;
    segment.steps = table.integer("steps", 1);
    for (std::size_t k = 0; k < 4; ++k) segment.target[k] = read_target(table, indices[k]);
    for (const char* stretch : {"F11", "F22"})
      if (table.has(stretch)) table.number(stretch, positive);
    table.close();
    segments.push_back(segment);
  }
  if (segments.empty()) scene.fail("segment", "nothing", "at least one [[segment]]");
  return segments;
}

Segment drained_segment(double axial, double lateral, int steps) {
  Segment segment;
  segment.steps = steps;
  segment.target[0] = {Control::cauchy, false, lateral};
  segment.target[3] = {Control::deformation, true, axial};
  return segment;
}

Segment shear_segment(double shear, int steps) {
  Segment segment;
  segment.steps = steps;
  segment.target[1] = {Control::deformation, true, shear};
  return segment;
}

}  // namespace verification

#include "point/path.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

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

// Follows a stretch through the segments, as far as it is prescribed.
class Stretch {
 public:
  void follow(const SceneTable& segment, const char* index, const Target& target) {
    constexpr double least = 0.5;
    if (target.control != Control::deformation) {
      reached_.reset();
      return;
    }
    const std::string key = (target.increment ? "dF" : "F") + std::string(index);
    const std::optional<double> from = target.increment ? reached_ : 0;
    if (from)
      reached_ = *from + target.value;
    else if (!target.increment)
      reached_ = target.value;
    const double stretch = reached_.value_or(1 + target.value);
    if (stretch > least) return;
    const std::string found = fmt::format("{:g}", target.value);
    if (target.increment)
      segment.fail(key, fmt::format("{}, which leads to F{} = {:g}", found, index, stretch),
                   "an increment of a stretch, -0.01 for 1 % of compression");
    segment.fail(key, found,
                 fmt::format("a stretch: 1 undeformed, 0.99 after 1 % of compression; dF{} = -0.01 "
                             "adds to what was reached",
                             index));
  }

 private:
  std::optional<double> reached_ = 1;
};

void check_tension(const SceneTable& segment, const char* index, const Target& target) {
  if (target.control == Control::deformation || !(target.value > 0)) return;
  segment.fail(
      (target.control == Control::piola ? "P" : "sigma") + std::string(index),
      fmt::format("{:g}, which is tension", target.value),
      fmt::format("a number <= 0, {:g} Pa for compression: contacts without bonds carry no "
                  "tension",
                  -target.value));
}

}  // namespace

std::vector<Segment> read_segments(SceneTable& scene, bool carries_tension) {
  std::vector<Segment> segments;
  std::array<Stretch, 2> stretch;
  for (SceneTable& table : scene.tables("segment")) {
    Segment segment;
    segment.steps = table.integer("steps", 1);
    for (std::size_t k = 0; k < 4; ++k) segment.target[k] = read_target(table, indices[k]);
    for (const std::size_t k : {0U, 3U}) {
      if (segment.target[k].control == Control::deformation && !segment.target[k].increment)
        table.number(std::string("F") + indices[k], positive);
      stretch[k / 3].follow(table, indices[k], segment.target[k]);
      if (!carries_tension) check_tension(table, indices[k], segment.target[k]);
    }
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

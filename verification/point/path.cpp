#include "point/path.hpp"

#include "point/laboratory_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace verification {
namespace {

struct Key {
  const char* prefix;
  Target target;
};
constexpr std::array<Key, 4> keys{{{"F", {Control::deformation, false, 0}},
                                   {"dF", {Control::deformation, true, 0}},
                                   {"P", {Control::piola, false, 0}},
                                   {"sigma", {Control::cauchy, false, 0}}}};

// "11", "12" and so on, by rows.
std::vector<std::string> component_names(int dimension) {
  std::vector<std::string> names;
  for (int i = 1; i <= dimension; ++i)
    for (int j = 1; j <= dimension; ++j) names.push_back(fmt::format("{}{}", i, j));
  return names;
}

// Index of "sigma22" among the components, or nothing.
std::optional<int> stress_named(std::string_view text, int dimension) {
  const std::vector<std::string> names = component_names(dimension);
  for (std::size_t k = 0; k < names.size(); ++k)
    if (text == "sigma" + names[k]) return static_cast<int>(k);
  return std::nullopt;
}

// Whether equal stresses form a cycle through this one, so that none is prescribed; sigma12 is
// sigma21.
bool forms_cycle(SceneTable& segment, const std::string& name) {
  const auto same = [&](const std::string& other) {
    return std::is_permutation(other.begin(), other.end(), name.begin(), name.end());
  };
  std::string at = name;
  for (int k = 0; k < 9 && segment.node(at) != nullptr && segment.node(at)->is_string(); ++k) {
    at = segment.text(at);
    if (same(at)) return true;
  }
  return false;
}

// Reads a stress that equals another one, or F that is found for the mean pressure.
Target read_words(SceneTable& segment, const std::string& name, int dimension) {
  const std::string text = segment.text(name);
  if (name[0] == 's') {
    const auto other = stress_named(text, dimension);
    if (!other || text == name)
      segment.fail(name, '"' + text + '"',
                   "a number in Pa, or the name of another stress: \"sigma22\"");
    if (forms_cycle(segment, name))
      segment.fail(name, fmt::format("\"{}\", which equals {} itself", text, name),
                   "one of the stresses that equal each other to be free, or a number");
    return {Control::difference, false, 0, *other};
  }
  if (name[0] != 'F' || text != "free" || !segment.has("mean_pressure"))
    segment.fail(name, '"' + text + '"',
                 name[0] == 'F' ? "a number, or \"free\" beside mean_pressure" : "a number");
  return {Control::mean, false, -segment.number("mean_pressure", positive)};
}

Target read_target(SceneTable& segment, const std::string& index, int dimension) {
  Target target;
  std::string given;
  for (const Key& key : keys) {
    const std::string name = key.prefix + index;
    if (segment.node(name) == nullptr) continue;
    if (!given.empty())
      segment.fail(name, "a second condition beside " + given, "one condition per component");
    target = key.target;
    if (segment.node(name)->is_string())
      target = read_words(segment, name, dimension);
    else
      target.value = segment.number(name);
    given = name;
  }
  return target;
}

// Tracks a stretch through the segments as far as it is prescribed.
class Stretch {
 public:
  void follow(const SceneTable& segment, const std::string& index, const Target& target) {
    constexpr double least = 0.5;
    if (target.control != Control::deformation) {
      reached_.reset();
      return;
    }
    const std::string key = (target.increment ? "dF" : "F") + index;
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

  // The stretch becomes an unknown.
  void lose() { reached_.reset(); }

 private:
  std::optional<double> reached_ = 1;
};

void check_tension(const SceneTable& segment, const std::string& index, const Target& target) {
  if (target.control == Control::deformation || !(target.value > 0)) return;
  segment.fail(
      (target.control == Control::piola ? "P" : "sigma") + index,
      fmt::format("{:g}, which is tension", target.value),
      fmt::format("a number <= 0, {:g} Pa for compression: contacts without bonds carry no "
                  "tension",
                  -target.value));
}

// Fails unless exactly one component of F is free for the mean pressure.
void check_mean_pressure(SceneTable& segment, const Segment& read) {
  const auto free = std::count_if(read.target.begin(), read.target.end(), [](const Target& target) {
    return target.control == Control::mean;
  });
  if (segment.has("mean_pressure") && free != 1)
    segment.fail("mean_pressure",
                 fmt::format("{} components of F that are \"free\" beside it", free),
                 "one, which is found: F11 = \"free\"");
}

// Fails for a component of spheres in a scene of discs.
void check_dimension(SceneTable& segment, int dimension) {
  if (dimension == 3) return;
  for (const std::string& index : component_names(3))
    for (const Key& key : keys)
      if (const std::string name = key.prefix + index;
          index.find('3') != std::string::npos && segment.has(name))
        segment.fail(name, "a component of three dimensions",
                     "one of 11, 12, 21, 22: the material has dimension = 2");
}

// Components of F that follow in a segment with isochoric = true.
std::array<bool, 3> read_following(SceneTable& segment, const Segment& read, int dimension) {
  if (!segment.flag_or("isochoric", false)) return {};
  std::array<bool, 3> following{};
  const std::vector<std::string> names = component_names(dimension);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& index = names[k];
    const bool given = read.target[k].control != Control::deformation || segment.has("F" + index) ||
                       segment.has("dF" + index);
    if (index[0] == index[1]) following[static_cast<std::size_t>(index[0] - '1')] = !given;
  }
  if (std::find(following.begin(), following.end(), true) == following.end())
    segment.fail("isochoric", "true, and all of the diagonal of F has a condition",
                 "one of it without a condition, which follows det F");
  return following;
}

}  // namespace

std::vector<Segment> read_segments(SceneTable& scene, bool bears_tension, int dimension) {
  std::vector<Segment> segments;
  std::array<Stretch, 3> stretch;
  const std::vector<std::string> names = component_names(dimension);
  for (SceneTable& table : scene.tables("segment")) {
    Segment segment;
    if (table.has("test")) {
      segment.test = std::make_shared<ElementTest>(read_element_test(table, dimension));
      segment.steps = segment.test->expected_steps();
      for (Stretch& one : stretch) one.lose();
      table.close();
      segments.push_back(segment);
      continue;
    }
    segment.steps = table.integer("steps", 1);
    check_dimension(table, dimension);
    for (std::size_t k = 0; k < names.size(); ++k)
      segment.target[k] = read_target(table, names[k], dimension);
    check_mean_pressure(table, segment);
    segment.keeps_volume = read_following(table, segment, dimension);
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
      const std::size_t k = i * static_cast<std::size_t>(dimension) + i;
      if (segment.target[k].control == Control::deformation && !segment.target[k].increment)
        table.number("F" + names[k], positive);
      if (segment.keeps_volume[i])
        stretch[i].lose();
      else
        stretch[i].follow(table, names[k], segment.target[k]);
      if (!bears_tension) check_tension(table, names[k], segment.target[k]);
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

Segment triaxial_segment(double axial, double lateral, int steps) {
  Segment segment;
  segment.steps = steps;
  segment.target[0] = segment.target[4] = {Control::cauchy, false, lateral};
  segment.target[8] = {Control::deformation, true, axial};
  return segment;
}

Segment shear_segment(double shear, int steps) {
  Segment segment;
  segment.steps = steps;
  segment.target[1] = {Control::deformation, true, shear};
  return segment;
}

}  // namespace verification

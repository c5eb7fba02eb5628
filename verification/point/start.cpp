#include "point/start.hpp"

#include "app/progress.hpp"
#include "app/snapshot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

namespace verification {
namespace {

// Beyond them somebody is more likely to have mixed up units than to mean it.
constexpr double least_stiffness = 30, most_stiffness = 1e7;  // kn / p [-]
constexpr double least_pressure = 1, most_pressure = 1e9;     // [Pa]
constexpr double most_friction = 1.5;                         // tan(56 degrees) [-]
constexpr double most_overlap = 0.1;                          // of the mean radius [-]

std::vector<std::string> unusual_of(const PackingStart& start, const MaterialSource& source) {
  std::vector<std::string> unusual;
  const auto say = [&](std::string text) { unusual.push_back(std::move(text)); };
  const toml::table material = unfold(source).changes;
  const double friction = material["contact"]["friction"].value_or(0.0);
  if (friction > most_friction) {
    const double degrees = 180 / std::numbers::pi * std::atan(friction);
    std::string text =
        fmt::format("contact.friction = {:g} is tan({:.3g} degrees)", friction, degrees);
    if (friction < 90)
      text += fmt::format("; tan({:g} degrees) is {:.3g}", friction,
                          std::tan(friction * std::numbers::pi / 180));
    say(text);
  }
  if (start.pressure < least_pressure)
    say(fmt::format(
        "a mean pressure of {:.3g} Pa: contact.young and kn are in Pa and N/m, lengths in m",
        start.pressure));
  if (start.pressure > most_pressure)
    say(fmt::format("a mean pressure of {:.3g} Pa: stiffer than any grain", start.pressure));
  if (start.stiffness > 0 && start.stiffness < least_stiffness)
    say(fmt::format("kn/p = {:.3g}, soft: usual are 300 to 1e5 (stiffer contacts or less pressure)",
                    start.stiffness));
  if (start.stiffness > most_stiffness)
    say(fmt::format("kn/p = {:.3g}, stiff: steps have to be as small as p/kn; usual are 300 to 1e5",
                    start.stiffness));
  if (start.overlap > most_overlap)
    say(fmt::format("a mean overlap of {:.3g} % of a radius", 100 * start.overlap));
  return unusual;
}

double thickness_of(const grainlaw_state* state, const Snapshot& snapshot) {
  const auto& h = snapshot.cell;
  return measure_scalar(state, GRAINLAW_VOLUME) / std::abs(h[0] * h[3] - h[1] * h[2]);
}

double mean_diameter(const Snapshot& snapshot) {
  const double sum = std::accumulate(snapshot.radius.begin(), snapshot.radius.end(), 0.0);
  return 2 * sum / static_cast<double>(snapshot.size());
}

// Where the diagonal of a tensor is among its components.
std::vector<std::size_t> diagonal(int dimension) {
  return dimension == 3 ? std::vector<std::size_t>{0, 4, 8} : std::vector<std::size_t>{0, 3};
}

}  // namespace

bool carries_tension(const MaterialSource& source) {
  const toml::table material = unfold(source).changes;
  return material["contact"]["law"].value_or(std::string_view()) == "bonded";
}

std::string PackingStart::brief() const {
  return fmt::format("mean pressure {:.4g} Pa, kn/p {:.3g} [-], void ratio {:.4g} [-]", pressure,
                     stiffness, void_ratio);
}

std::string PackingStart::text() const {
  std::string text = brief() + fmt::format(", mean overlap {:.2g} % of a radius", 100 * overlap);
  if (!unusual.empty()) text += fmt::format("; unusual: {}", fmt::join(unusual, "; "));
  return text;
}

PackingStart look_at_start(const grainlaw_state* state, const MaterialSource& source) {
  PackingStart start;
  const std::vector<double> sigma = measure(state, GRAINLAW_CAUCHY_STRESS);
  const bool spheres = sigma.size() == 9;
  start.pressure = spheres ? -(sigma[0] + sigma[4] + sigma[8]) / 3 : -0.5 * (sigma[0] + sigma[3]);
  start.dimension = spheres ? 3 : 2;
  start.void_ratio = measure_scalar(state, GRAINLAW_VOID_RATIO);
  const Snapshot snapshot = take_snapshot(state);
  start.particles = static_cast<int>(snapshot.size());
  start.overlap = normalised_overlap(snapshot);
  double force = 0, overlap = 0;
  for (const SnapshotContact& contact : snapshot.contacts) {
    const double depth = snapshot.radius[static_cast<std::size_t>(contact.i)] +
                         snapshot.radius[static_cast<std::size_t>(contact.j)] - contact.length();
    if (!(depth > 0) || !(contact.normal_force > 0)) continue;
    force += contact.normal_force;
    overlap += depth;
  }
  const double thickness = spheres ? mean_diameter(snapshot) : thickness_of(state, snapshot);
  if (overlap > 0 && start.pressure > 0)
    start.stiffness = force / overlap / (start.pressure * thickness);
  start.unusual = unusual_of(start, source);
  return start;
}

std::vector<std::string> far_targets(const PackingStart& start, const std::vector<Segment>& path) {
  constexpr double far = 100;  // times the pressure, or a hundredth
  std::vector<std::string> texts;
  for (const Segment& segment : path)
    for (const std::size_t k : diagonal(start.dimension)) {
      const Target& target = segment.target[k];
      const double ratio = -target.value / start.pressure;
      if (target.control == Control::deformation || !(ratio > 0)) continue;
      if (ratio < far && ratio > 1 / far) continue;
      texts.push_back(fmt::format(
          "a target of {:.3g} Pa in direction {} for a packing under {:.3g} Pa: is it in Pa?",
          target.value, 1 + k / static_cast<std::size_t>(start.dimension + 1), start.pressure));
    }
  return texts;
}

std::string smaller_steps(const PackingStart& start, const Segment& segment) {
  double strain = 0;
  for (const Target& target : segment.target)
    if (target.control == Control::deformation && target.increment)
      strain = std::max(strain, std::abs(target.value) / segment.steps);
  for (const std::size_t k : diagonal(start.dimension))
    if (segment.target[k].control == Control::deformation && !segment.target[k].increment)
      strain = std::max(strain, std::abs(segment.target[k].value - 1) / segment.steps);
  const double hard = strain * start.stiffness;
  if (hard > 1)
    return fmt::format(
        "try {:.6g} steps or more instead of {}: each strains by {:.2g}, {:.2g} times "
        "p/kn",
        std::ceil(hard * segment.steps), segment.steps, strain, hard);
  return "try smaller steps, solver.tolerance = 1e-8, or loose_tolerance";
}

std::string why_at_start(const PackingStart& start, int steps_done, const std::string& to_try) {
  constexpr int first_steps = 3;
  if (steps_done >= first_steps) return {};
  return fmt::format("; the packing starts with {}; {}", start.text(),
                     start.unusual.empty() ? to_try : "look at what is unusual, then " + to_try);
}

void warn(const std::string& name, const PackingStart& start) {
  for (const std::string& text : start.unusual) tell(fmt::format("{}: unusual: {}\n", name, text));
}

void tell_start(const std::string& name, const PackingStart& start) {
  fmt::print("{}: starts at {}\n", name, start.brief());
  std::fflush(stdout);
  warn(name, start);
}

}  // namespace verification

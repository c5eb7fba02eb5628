#include "point/start.hpp"

#include "app/progress.hpp"
#include "app/snapshot.hpp"
#include "point/laboratory_test.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <utility>

namespace verification {
namespace {

// Values beyond these bounds are more likely mistaken units than meant.
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
  if (const std::string text = unusual_stiffness(start.stiffness); !text.empty()) say(text);
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

// Indices of the diagonal among a tensor's components.
std::vector<std::size_t> diagonal(int dimension) {
  return dimension == 3 ? std::vector<std::size_t>{0, 4, 8} : std::vector<std::size_t>{0, 3};
}

// The largest strain that a step prescribes [-].
double strain_of_step(const Segment& segment, int dimension) {
  double strain = 0;
  for (const Target& target : segment.target)
    if (target.control == Control::deformation && target.increment)
      strain = std::max(strain, std::abs(target.value) / segment.steps);
  for (const std::size_t k : diagonal(dimension))
    if (segment.target[k].control == Control::deformation && !segment.target[k].increment)
      strain = std::max(strain, std::abs(segment.target[k].value - 1) / segment.steps);
  return strain;
}

// The component of stress furthest from where it is led, -1 where strain leads.
int leading_stress(const Segment& segment, const Eigen::VectorXd& cauchy) {
  if (segment.test) return -1;
  int leading = -1;
  double furthest = 0;
  for (Eigen::Index k = 0; k < cauchy.size(); ++k) {
    const Target& target = segment.target[static_cast<std::size_t>(k)];
    const bool stress = target.control == Control::cauchy || target.control == Control::piola;
    if (target.control == Control::deformation && !(target.increment && target.value == 0))
      return -1;
    if (!stress || std::abs(target.value - cauchy(k)) <= furthest) continue;
    furthest = std::abs(target.value - cauchy(k));
    leading = static_cast<int>(k);
  }
  return leading;
}

// Where smaller steps do not help.
std::string cure_of(grainlaw_status status) {
  if (status == GRAINLAW_CONTACTS_LOST)
    return "; extend it less, or solver.contacts_lost = \"stress_free\" where that is meant";
  if (status == GRAINLAW_COLLAPSED) return "; try boundary.type = \"frame-p\", or more particles";
  return {};
}

}  // namespace

bool bears_tension(const MaterialSource& source) {
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

PackingStart measure_start(const grainlaw_state* state, const MaterialSource& source) {
  PackingStart start;
  const std::vector<double> sigma = measure(state, GRAINLAW_CAUCHY_STRESS);
  const bool spheres = sigma.size() == 9;
  start.pressure = spheres ? -(sigma[0] + sigma[4] + sigma[8]) / 3 : -0.5 * (sigma[0] + sigma[3]);
  start.pressure += 0.0;  // no -0
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
  start.drag = has_drag(source);
  start.unusual = unusual_of(start, source);
  return start;
}

std::vector<std::string> far_targets(const PackingStart& start, const std::vector<Segment>& path) {
  constexpr double far = 100;  // ratio to the pressure, or its inverse
  std::vector<std::string> texts;
  const auto ask = [&](double compression, const std::string& what) {
    const double ratio = compression / start.pressure;
    if (!(ratio > 0) || (ratio < far && ratio > 1 / far)) return;
    texts.push_back(
        fmt::format("{} for a packing under {:.3g} Pa: is it in Pa?", what, start.pressure));
  };
  for (const Segment& segment : path) {
    for (const std::size_t k : diagonal(start.dimension))
      if (const Target& target = segment.target[k]; target.control != Control::deformation)
        ask(-target.value, fmt::format("a target of {:.3g} Pa in direction {}", target.value,
                                       1 + k / static_cast<std::size_t>(start.dimension + 1)));
    if (!segment.test) continue;
    for (const auto& [key, value] : segment.test->stresses())
      ask(value, fmt::format("{} = {:.3g} Pa", key, value));
  }
  return texts;
}

std::string unusual_stiffness(double stiffness) {
  std::string text;
  const auto say = [&](std::string what) { text = std::move(what); };
  if (stiffness > 0 && stiffness < least_stiffness)
    say(fmt::format("kn/p = {:.3g}, soft: usual are 300 to 1e5 (stiffer contacts or less pressure)",
                    stiffness));
  if (stiffness > most_stiffness)
    say(fmt::format("kn/p = {:.3g}, stiff: steps have to be as small as p/kn; usual are 300 to 1e5",
                    stiffness));
  return text;
}

constexpr const char* law_in_time =
    "solver.viscous_number = 1e-3 with viscous_rate, the strain of a step";

std::string why_at_start(const PackingStart& start, int steps_done) {
  constexpr int first_steps = 3;
  if (steps_done >= first_steps) return {};
  return fmt::format("; the packing starts with {}{}", start.text(),
                     start.unusual.empty() ? "" : "; look at what is unusual first");
}

std::string load_advice(const PackingStart& start, int steps_done, grainlaw_status status) {
  if (status == GRAINLAW_CONTACTS_LOST)
    return why_at_start(start, steps_done) +
           "; try more particles, displacement in place of a load that the body may not carry, or "
           "solver.contacts_lost = \"stress_free\" where packings may come apart";
  if (status == GRAINLAW_COLLAPSED) return why_at_start(start, steps_done) + cure_of(status);
  return why_at_start(start, steps_done) +
         fmt::format(
             "; try more load steps{}, or displacement in place of a load that the body may not "
             "carry",
             start.drag ? "" : fmt::format(", {}", law_in_time));
}

std::string path_advice(const PackingStart& start, int steps_done, grainlaw_status status,
                        const Segment& segment, const Eigen::VectorXd& cauchy) {
  const std::string why = why_at_start(start, steps_done);
  if (const int k = leading_stress(segment, cauchy); k >= 0) {
    const std::string index = fmt::format("{}{}", 1 + k / start.dimension, 1 + k % start.dimension);
    return why + fmt::format(
                     "; the packing may not carry this stress: prescribe F{0}, not sigma{0}, "
                     "to see how much it carries",
                     index);
  }
  if (const std::string cure = cure_of(status); !cure.empty()) return why + cure;
  const double strain = strain_of_step(segment, start.dimension), hard = strain * start.stiffness;
  if (!why.empty() && hard > 1 && !segment.test)
    return why + fmt::format(
                     "; try {:.6g} steps or more instead of {}: each strains by {:.2g}, {:.2g} "
                     "times p/kn",
                     std::ceil(hard * segment.steps), segment.steps, strain, hard);
  return why + "; try more steps" + (start.drag ? "" : fmt::format(", or {}", law_in_time));
}

void warn(const std::string& name, const PackingStart& start) {
  for (const std::string& text : start.unusual) tell(fmt::format("{}: unusual: {}\n", name, text));
}

void print_start(const std::string& name, const PackingStart& start) {
  fmt::print("{}: starts at {}\n", name, start.brief());
  std::fflush(stdout);
  warn(name, start);
}

}  // namespace verification

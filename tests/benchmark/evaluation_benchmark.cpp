// What one evaluation costs along the drained biaxial test of the reference packing: axial
// shortening in increments of 0.1 % at constant lateral stress, the lateral stretch found by
// Newton's method with the exact tangent. Every evaluation of that path is a sample; it is done
// again, from the state that was committed then, with other tolerances, with and without the
// tangent.
#include "../data.hpp"

#include <grainlaw/grainlaw.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace {

using grainlaw::Material;
using grainlaw::State;
using Tensor = std::array<double, 4>;
using Tangent = std::array<double, 16>;

constexpr double increment = 1e-3;    // of the axial stretch
constexpr double last_strain = 0.04;  // past the peak
// Axial strains between which samples are taken; from about 1.5 % on the packing is chaotic.
constexpr std::array<std::array<double, 2>, 3> ranges{{{0, 0.01}, {0, 0.015}, {0.015, 0.04}}};
constexpr int path_digits = 8;  // of the tolerance, for the states the samples start from

// Tolerance 10^-digits.
Material material(int digits) {
  const std::string data = grainlaw::test::data_folder();
  const std::string text =
      "dimension = 2\n"
      "[packing]\n"
      "particles = \"rve400_particles.csv\"\n"
      "contacts = \"rve400_contacts.csv\"\n"
      "cell = \"rve400_cell.csv\"\n"
      "[contact]\n"
      "law = \"frictional\"\n"
      "young = 6e8\n"
      "ratio = 0.8\n"
      "friction = 0.5463024898437905\n"
      "[solver]\n"
      "tolerance = 1e-" +
      std::to_string(digits) + "\n";
  return Material::parse(text, data);
}

// The committed state of an increment, and the F that were tried from there.
struct Step {
  double strain = 0;  // at its end
  std::vector<std::byte> committed;
  std::vector<Tensor> tried;
};

// Newton's method on the lateral stretch. A step that does not get there, as happens after the
// peak, goes on from its best try: what evaluations cost is asked, not what the strength is.
Step make_step(State& state, double axial, double& lateral, double& rate) {
  constexpr double lateral_stress = -1e5;  // [Pa]
  constexpr double tolerance = 1e-6;
  constexpr int most_tries = 8;
  Step step;
  step.strain = 1 - axial;
  const double start = lateral;
  lateral += rate;
  step.committed = state.save();
  double best = std::numeric_limits<double>::infinity();
  double best_lateral = lateral;
  for (int k = 0; k < most_tries && best > tolerance; ++k) {
    const Tensor F{lateral, 0, 0, axial};
    Tensor P{};
    Tangent A{};
    step.tried.push_back(F);
    if (!state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A)) break;
    const double error = P[0] / axial - lateral_stress;  // Cauchy stress: P11 F11 / det F
    if (std::abs(error / lateral_stress) < best) {
      best = std::abs(error / lateral_stress);
      best_lateral = lateral;
    }
    lateral -= std::clamp(error * axial / A[0], -increment, increment);
  }
  lateral = best_lateral;
  rate = lateral - start;
  Tensor P{};
  if (state.evaluate({{lateral, 0, 0, axial}}, P)) state.commit();
  return step;
}

const std::vector<Step>& path() {
  static const std::vector<Step> steps = [] {
    State state(material(path_digits));
    std::vector<Step> made;
    double lateral = 1;
    double rate = 0;  // of the lateral stretch, per step
    for (double strain = increment; strain < last_strain + 0.5 * increment; strain += increment) {
      made.push_back(make_step(state, 1 - strain, lateral, rate));
    }
    return made;
  }();
  return steps;
}

// Arguments: decimal digits of the tolerance; 1 with the exact tangent; 0 before, 1 after the
// chaos.
void evaluation(benchmark::State& timing) {
  const unsigned want = timing.range(1) != 0 ? unsigned{GRAINLAW_WANT_TANGENT_EXACT} : 0U;
  const auto& range = ranges[static_cast<std::size_t>(timing.range(2))];
  const Material solved = material(static_cast<int>(timing.range(0)));
  std::vector<std::pair<State, const Step*>> samples;
  std::size_t evaluations = 0;
  for (const Step& step : path()) {
    const double middle = step.strain - 0.5 * increment;
    if (middle < range[0] || middle > range[1]) continue;
    State state(solved);
    state.load(step.committed);
    samples.emplace_back(std::move(state), &step);
    evaluations += step.tried.size();
  }

  double steps = 0;
  double factorisations = 0;
  double failures = 0;
  for (auto _ : timing) {
    for (auto& [state, step] : samples) {
      for (const Tensor& F : step->tried) {
        Tensor P{};
        Tangent A{};
        const auto done = want != 0 ? state.evaluate(F, P, want, A) : state.evaluate(F, P);
        benchmark::DoNotOptimize(P);
        steps += static_cast<double>(done.report.relaxation_steps);
        factorisations += done.report.factorisations;
        failures += done ? 0 : 1;
      }
    }
  }
  const double all = static_cast<double>(evaluations) * static_cast<double>(timing.iterations());
  using benchmark::Counter;
  timing.counters["evaluations"] = static_cast<double>(evaluations);
  timing.counters["cpu_ms"] = Counter(all / 1000, Counter::kIsRate | Counter::kInvert);
  timing.counters["relaxation_steps"] = steps / all;
  timing.counters["factorisations"] = factorisations / all;
  timing.counters["failures"] = failures / static_cast<double>(timing.iterations());
}

BENCHMARK(evaluation)
    ->ArgNames({"digits", "tangent", "range"})
    ->ArgsProduct({{8, 6, 4}, {0, 1}, {0, 1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.3);

}  // namespace

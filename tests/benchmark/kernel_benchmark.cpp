// The engine's inner loops, on the reference packing in the middle of an increment of 0.1 %.
#include "equilibrium/chain.hpp"
#include "material/material.hpp"
#include "material/material_file.hpp"

#include <benchmark/benchmark.h>

#include <array>
#include <vector>

namespace {

using namespace grainlaw;

constexpr std::array<double, 4> target{1.0004, 0, 0, 0.999};

const Material& material() {
  static const auto instance = make_material(read_material_file(GRAINLAW_TEST_DATA "/rve400.toml"));
  return *instance;
}

// An increment that has come to rest, with its contacts' status mixed.
Workspace solved() {
  static const Problem problem = material().problem();
  Request request{&problem, &material().solver, &material().initial, target};
  request.tolerance = 1e-6;
  Workspace workspace;
  solve(request, workspace);
  return workspace;
}

void begin_increment(benchmark::State& timing) {
  const Problem problem = material().problem();
  Increment increment;
  for (auto _ : timing) increment.begin(problem, material().initial, target);
}
BENCHMARK(begin_increment)->Unit(benchmark::kMicrosecond);

void contact_forces(benchmark::State& timing) {
  Workspace workspace = solved();
  for (auto _ : timing) {
    workspace.increment.update_forces();
    benchmark::ClobberMemory();
  }
}
BENCHMARK(contact_forces)->Unit(benchmark::kMicrosecond);

// Divided by the counter `steps`: a relaxation step, with its share of new masses.
void relaxation(benchmark::State& timing) {
  const Problem problem = material().problem();
  constexpr long steps = 500;
  Workspace workspace;
  for (auto _ : timing) {
    workspace.increment.begin(problem, material().initial, target);
    workspace.increment.refresh_masses();
    relax(workspace.increment, 0, steps, History::committed, workspace.relaxation);
  }
  timing.counters["steps"] = steps;
}
BENCHMARK(relaxation)->Unit(benchmark::kMicrosecond);

void assembly(benchmark::State& timing) {
  Workspace workspace = solved();
  for (auto _ : timing) workspace.newton.stiffness.assemble(workspace.increment, 0);
}
BENCHMARK(assembly)->Unit(benchmark::kMicrosecond);

void factorisation(benchmark::State& timing) {
  Workspace workspace = solved();
  workspace.newton.stiffness.assemble(workspace.increment, 0);
  for (auto _ : timing) workspace.newton.stiffness.factorise(workspace.increment);
}
BENCHMARK(factorisation)->Unit(benchmark::kMicrosecond);

void linear_solve(benchmark::State& timing) {
  Workspace workspace = solved();
  auto& stiffness = workspace.newton.stiffness;
  stiffness.assemble(workspace.increment, 0);
  stiffness.factorise(workspace.increment);
  const std::vector<double> right(workspace.increment.unknowns(), 1.0);
  std::vector<double> x(right.size());
  for (auto _ : timing) {
    if (!stiffness.solve(workspace.increment, right, x)) timing.SkipWithError("singular");
    benchmark::DoNotOptimize(x.data());
  }
}
BENCHMARK(linear_solve)->Unit(benchmark::kMicrosecond);

}  // namespace

// The engine's inner loops, on the reference packing in the middle of an increment of 0.1 %.
#include "../data.hpp"
#include "equilibrium/strategy.hpp"
#include "material/material.hpp"
#include "material/material_file.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace {

using namespace grainlaw::core;

constexpr std::array<double, 4> target{1.0004, 0, 0, 0.999};

const Material<2>& material() {
  static const auto instance =
      make_material<2>(read_material_file(grainlaw::test::data_file("rve400.toml")));
  return *instance;
}

// The packing side by side with itself, `side` x `side` times, particles numbered at random.
std::shared_ptr<const Material<2>> tiled(int side) {
  MaterialDescription description = read_material_file(grainlaw::test::data_file("rve400.toml"));
  const Packing one = description.packing;
  Packing& many = description.packing;
  const std::size_t n = one.size();
  const auto tiles = static_cast<std::size_t>(side * side);
  std::vector<int> number(n * tiles);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937_64(1));
  const auto of = [&](int p, int a, int b) {
    return number[n * static_cast<std::size_t>(a * side + b) + static_cast<std::size_t>(p)];
  };
  const auto& h = one.cell;
  many.cell = {side * h[0], side * h[1], side * h[2], side * h[3]};
  many.position.resize(2 * n * tiles);
  many.radius.resize(n * tiles);
  many.contacts.clear();
  for (int a = 0; a < side; ++a) {
    for (int b = 0; b < side; ++b) {
      for (std::size_t p = 0; p < n; ++p) {
        const auto q = static_cast<std::size_t>(of(static_cast<int>(p), a, b));
        many.position[q] = one.position[p] + h[0] * a + h[1] * b;
        many.position[n * tiles + q] = one.position[n + p] + h[2] * a + h[3] * b;
        many.radius[q] = one.radius[p];
      }
      for (InitialContact contact : one.contacts) {
        const auto wrap = [&](int cell, int& shift) {
          const int wrapped = ((cell + shift) % side + side) % side;
          shift = (cell + shift - wrapped) / side;
          return wrapped;
        };
        const int i = of(contact.i, a, b);
        const int a_of_j = wrap(a, contact.shift[0]);
        contact.j = of(contact.j, a_of_j, wrap(b, contact.shift[1]));
        contact.i = i;
        many.contacts.push_back(contact);
      }
    }
  }
  return make_material<2>(std::move(description));
}

// An increment that has come to rest, with its contacts' status mixed.
Workspace<2> solved() {
  static const Problem<2> problem = material().problem();
  Request<2> request{&problem, &material().solver, &material().initial, target};
  request.tolerance = 1e-6;
  Workspace<2> workspace;
  solve(request, workspace);
  return workspace;
}

void begin_increment(benchmark::State& timing) {
  const Problem<2> problem = material().problem();
  Increment<2> increment;
  for (auto _ : timing) increment.begin(problem, material().initial, target);
}
BENCHMARK(begin_increment)->Unit(benchmark::kMicrosecond);

void contact_forces(benchmark::State& timing) {
  Workspace<2> workspace = solved();
  for (auto _ : timing) {
    workspace.increment.update_forces();
    benchmark::ClobberMemory();
  }
}
BENCHMARK(contact_forces)->Unit(benchmark::kMicrosecond);

// Divided by the counter `steps`: a relaxation step, with its share of new masses.
void relaxation(benchmark::State& timing) {
  const auto packing = tiled(static_cast<int>(timing.range(0)));
  const Problem<2> problem = packing->problem();
  constexpr long steps = 500;
  Workspace<2> workspace;
  for (auto _ : timing) {
    workspace.increment.begin(problem, packing->initial, target);
    workspace.increment.refresh_masses();
    relax(workspace.increment, 0, steps, History::committed, workspace.relaxation);
  }
  timing.counters["steps"] = steps;
  timing.counters["particles"] = static_cast<double>(packing->packing.size());
}
BENCHMARK(relaxation)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMicrosecond);

// Stiffness of the packing `side` x `side` times, in the middle of an increment.
class Assembled {
 public:
  explicit Assembled(const benchmark::State& timing)
      : packing_(tiled(static_cast<int>(timing.range(0)))), problem_(packing_->problem()) {
    workspace.increment.begin(problem_, packing_->initial, target);
    workspace.increment.refresh_masses();
    relax(workspace.increment, 1e-3, 2000, History::committed, workspace.relaxation);
    workspace.newton.stiffness.assemble(workspace.increment, 0);
  }
  Workspace<2> workspace;

 private:
  std::shared_ptr<const Material<2>> packing_;
  Problem<2> problem_;
};

void assembly(benchmark::State& timing) {
  Assembled at(timing);
  for (auto _ : timing) at.workspace.newton.stiffness.assemble(at.workspace.increment, 0);
}
BENCHMARK(assembly)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMicrosecond);

void factorisation(benchmark::State& timing) {
  Assembled at(timing);
  for (auto _ : timing) at.workspace.newton.stiffness.factorise(at.workspace.increment);
}
BENCHMARK(factorisation)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMicrosecond);

void linear_solve(benchmark::State& timing) {
  Assembled at(timing);
  auto& workspace = at.workspace;
  auto& stiffness = workspace.newton.stiffness;
  stiffness.factorise(workspace.increment);
  const auto residual = workspace.increment.residual();
  const std::vector<double> right(residual.begin(), residual.end());
  std::vector<double> x(right.size());
  for (auto _ : timing) {
    if (!stiffness.solve(workspace.increment, right, x)) timing.SkipWithError("singular");
    benchmark::DoNotOptimize(x.data());
  }
}
BENCHMARK(linear_solve)->Arg(1)->Arg(2)->Arg(4)->Unit(benchmark::kMicrosecond);

}  // namespace

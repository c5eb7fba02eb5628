// A state through the C ABI: kinds of tangent, a batch by threads, saving and loading.
#include "../data.hpp"

#include <grainlaw/grainlaw.hpp>

#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <vector>

namespace {

using grainlaw::Material;
using grainlaw::State;
using Tensor = std::array<double, 4>;
using Tangent = std::array<double, 16>;

const Material& material() {
  static const Material instance = Material::load(grainlaw::test::data_file("rve400.toml"));
  return instance;
}

Tensor compressed(double strain) { return {1 + 0.4 * strain, 0, 0, 1 - strain}; }

// At 0.2 % axial strain.
State loaded_state() {
  State state(material());
  Tensor P{};
  if (state.evaluate(compressed(2e-3), P)) state.commit();
  return state;
}

// Argument: the bit of `want`; 0: no tangent.
void tangent(benchmark::State& timing) {
  const auto want = static_cast<unsigned>(timing.range(0));
  State state = loaded_state();
  const Tensor F = compressed(3e-3);
  Tensor P{};
  Tangent A{};
  for (auto _ : timing) {
    const auto done = want != 0 ? state.evaluate(F, P, want, A) : state.evaluate(F, P);
    if (!done) timing.SkipWithError(done.report.message);
  }
}
BENCHMARK(tangent)
    ->ArgName("want")
    ->Arg(0)
    ->Arg(GRAINLAW_WANT_TANGENT_EXACT)
    ->Arg(GRAINLAW_WANT_TANGENT_ELASTIC)
    ->Arg(GRAINLAW_WANT_TANGENT_PERTURBED)
    ->Unit(benchmark::kMillisecond);

// Argument: threads. Sixteen points, the dearer the later.
void batch(benchmark::State& timing) {
  constexpr std::size_t points = 16;
  const auto threads = static_cast<int>(timing.range(0));
  std::vector<State> states(points, loaded_state());
  std::vector<grainlaw_state*> handles;
  std::vector<Tensor> F, P(points);
  for (std::size_t k = 0; k < points; ++k) {
    handles.push_back(states[k].get());
    F.push_back(compressed(2e-3 + 1e-4 * static_cast<double>(k)));
  }
  std::vector<grainlaw_status> status(points);
  for (auto _ : timing) {
    grainlaw_evaluate_batch(points, handles.data(), F.front().data(), 0, P.front().data(), nullptr,
                            status.data(), nullptr, threads);
  }
}
BENCHMARK(batch)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void save(benchmark::State& timing) {
  const State state = loaded_state();
  std::vector<std::byte> bytes = state.save();
  for (auto _ : timing) {
    std::size_t size = bytes.size();
    grainlaw_state_save(state.get(), bytes.data(), &size);
    benchmark::ClobberMemory();
  }
  timing.counters["bytes"] = static_cast<double>(bytes.size());
}
BENCHMARK(save)->Unit(benchmark::kMicrosecond);

void load(benchmark::State& timing) {
  State state = loaded_state();
  const std::vector<std::byte> bytes = state.save();
  for (auto _ : timing) state.load(bytes);
  timing.counters["bytes"] = static_cast<double>(bytes.size());
}
BENCHMARK(load)->Unit(benchmark::kMicrosecond);

}  // namespace

#include "study/features/cost.hpp"

#include "study/clock.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <thread>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace verification {
namespace {

// What malloc has handed out and not got back; only glibc says.
double heap_bytes() {
#if defined(__GLIBC__)
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
#else
  return std::numeric_limits<double>::quiet_NaN();
#endif
}

struct Led {
  State state;
  double cpu = 0;  // [ms]
  long evaluations = 0;
  long relaxation_steps = 0;
  long factorisations = 0;
};

Led lead(const Material& material, const std::vector<Increment>& path, const Usage& usage) {
  Led led{make_state(material)};
  grainlaw_state* const state = led.state.get();
  for (const Increment& increment : path) {
    for (const Tensor& deformation : increment) {
      const double start = cpu_milliseconds();
      const Evaluation found = evaluate(state, deformation, usage.want);
      led.cpu += cpu_milliseconds() - start;
      check(found.status, "an increment of the feature table");
      ++led.evaluations;
      led.relaxation_steps += found.report.relaxation_steps;
      led.factorisations += found.report.factorisations;
    }
    if (usage.also) {
      const double start = cpu_milliseconds();
      usage.also(state);
      led.cpu += cpu_milliseconds() - start;
    }
    check(grainlaw_commit(state), "committing an increment of the feature table");
  }
  return led;
}

// Memory of a thread that has evaluated, over that of a state which has taken all it needs.
double workspace_bytes(const State& state, const Tensor& deformation, unsigned want) {
  evaluate(state.get(), deformation, want);
  check(grainlaw_revert(state.get()), "dropping a trial");
  double bytes = 0;
  std::thread([&] {
    const double before = heap_bytes();
    evaluate(state.get(), deformation, want);
    bytes = heap_bytes() - before;
  }).join();
  return bytes;
}

}  // namespace

Cost measure_cost(const MaterialSource& source, const std::vector<Increment>& path,
                  const Usage& usage) {
  constexpr std::size_t repetitions = 3;
  make_material(source);  // what is loaded and allocated once in a process
  Cost cost;
  double bytes = heap_bytes();
  const Material material = make_material(source);
  cost.material = heap_bytes() - bytes;

  lead(material, path, usage);  // the memory of this thread
  std::vector<Led> runs;
  runs.reserve(repetitions);
  bytes = heap_bytes();
  for (std::size_t k = 0; k < repetitions; ++k) runs.push_back(lead(material, path, usage));
  cost.state = (heap_bytes() - bytes) / static_cast<double>(repetitions);
  const Led& best = *std::ranges::min_element(runs, {}, &Led::cpu);
  const auto evaluations = static_cast<double>(best.evaluations);
  cost.cpu = best.cpu / evaluations;
  cost.relaxation_steps = static_cast<double>(best.relaxation_steps) / evaluations;
  cost.factorisations = static_cast<double>(best.factorisations) / evaluations;
  cost.workspace = workspace_bytes(best.state, path.back().back(), usage.want);
  std::size_t size = 0;
  check(grainlaw_state_save(best.state.get(), nullptr, &size), "sizing a saved state");
  cost.saved = static_cast<double>(size);
  cost.particles = measure_scalar(best.state.get(), GRAINLAW_PARTICLES);
  return cost;
}

}  // namespace verification

#include "evidence/studies/features/cost.hpp"

#include "evidence/studies/clock.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <thread>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace verification {

double heap_bytes() {
#if defined(__GLIBC__)
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
#else
  return std::numeric_limits<double>::quiet_NaN();
#endif
}

namespace {

struct Led {
  State state;
  std::vector<double> cpu = {};  // of every increment [ms]
  long evaluations = 0;
  long relaxation_steps = 0;
  long factorisations = 0;
};

template <int D>
Led lead(const Material& material, const std::vector<Increment<D>>& path, const Usage& usage) {
  Led led{State(material)};
  State& state = led.state;
  for (const Increment<D>& increment : path) {
    double& cpu = led.cpu.emplace_back();
    for (const TensorOf<D>& deformation : increment) {
      const double start = cpu_milliseconds();
      const auto found = evaluate_of<D>(state, deformation, usage.want);
      cpu += cpu_milliseconds() - start;
      check(found.status, "an increment of the feature table");
      ++led.evaluations;
      led.relaxation_steps += found.report.relaxation_steps;
      led.factorisations += found.report.factorisations;
    }
    if (usage.also) {
      const double start = cpu_milliseconds();
      usage.also(state);
      cpu += cpu_milliseconds() - start;
    }
    state.commit();
  }
  return led;
}

// Memory of a thread that has evaluated, over that of a state which has taken all it needs.
template <int D>
double workspace_bytes(State& state, const TensorOf<D>& deformation, unsigned want) {
  evaluate_of<D>(state, deformation, want);
  state.revert();
  double bytes = 0;
  std::thread([&] {
    const double before = heap_bytes();
    evaluate_of<D>(state, deformation, want);
    bytes = heap_bytes() - before;
  }).join();
  return bytes;
}

}  // namespace

template <int D>
CostMeasurement<D>::CostMeasurement(const MaterialSource& source,
                                    const std::vector<Increment<D>>& path, const Usage& usage)
    : path_(path), usage_(usage) {
  make_material(source, D);  // what is loaded and allocated once in a process
  double bytes = heap_bytes();
  material_ = make_material(source, D);
  cost_.material = heap_bytes() - bytes;

  const Led led = lead<D>(*material_, path_, usage_);  // takes the memory of this thread, too
  cpu_ = led.cpu;
  bytes = heap_bytes();
  State state = lead<D>(*material_, path_, usage_).state;
  cost_.state = heap_bytes() - bytes;
  evaluations_ = static_cast<double>(led.evaluations);
  cost_.relaxation_steps = static_cast<double>(led.relaxation_steps) / evaluations_;
  cost_.factorisations = static_cast<double>(led.factorisations) / evaluations_;
  cost_.workspace = workspace_bytes<D>(state, path_.back().back(), usage_.want);
  cost_.saved = static_cast<double>(state.save().size());
  cost_.particles = measure_scalar(state.get(), GRAINLAW_PARTICLES);
}

template <int D>
void CostMeasurement<D>::again() {
  const Led led = lead<D>(*material_, path_, usage_);
  for (std::size_t k = 0; k < cpu_.size(); ++k) cpu_[k] = std::min(cpu_[k], led.cpu[k]);
}

template <int D>
Cost CostMeasurement<D>::cost() const {
  Cost cost = cost_;
  cost.cpu = std::accumulate(cpu_.begin(), cpu_.end(), 0.0) / evaluations_;
  return cost;
}

template class CostMeasurement<2>;
template class CostMeasurement<3>;

}  // namespace verification

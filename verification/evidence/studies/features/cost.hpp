// What a material costs along a path: processor time per evaluation and bytes of memory.
#pragma once

#include "app/library.hpp"
#include "app/material.hpp"

#include <functional>
#include <vector>

namespace verification {

// What malloc has handed out and not got back; only glibc says, else NaN.
double heap_bytes();

// One increment: the F that are tried one after the other; the last one is committed.
template <int D>
using Increment = std::vector<TensorOf<D>>;

struct Usage {
  unsigned want = 0;  // tangent
  // What else is done with the trial of every increment.
  std::function<void(State&)> also;
};

struct Cost {
  double cpu = 0;               // per evaluation, with everything else that was asked for [ms]
  double relaxation_steps = 0;  // per evaluation [-]
  double factorisations = 0;    // per evaluation [-]
  // Bytes that malloc has handed out, its own bookkeeping included; NaN where it does not say.
  double state = 0;      // one state at the end of the path [bytes]
  double workspace = 0;  // one thread that evaluates [bytes]
  double material = 0;   // shared by all states: packing, equilibrium at F = I [bytes]
  double saved = 0;      // grainlaw_state_save at the end of the path [bytes]
  double particles = 0;  // [-]
};

// New states are led along the path, which has to outlive this; every increment counts with its
// best time. Throws ComputationError when an increment fails.
template <int D>
class CostMeasurement {
 public:
  CostMeasurement(const MaterialSource& source, const std::vector<Increment<D>>& path,
                  const Usage& usage);
  void again();
  [[nodiscard]] Cost cost() const;

 private:
  const std::vector<Increment<D>>& path_;
  Usage usage_;
  std::optional<Material> material_;
  Cost cost_;
  double evaluations_ = 0;
  std::vector<double> cpu_;  // of every increment [ms]
};

}  // namespace verification

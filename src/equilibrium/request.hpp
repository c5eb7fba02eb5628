// What an equilibrium is asked for, what came of it, and the memory it is found with.
#pragma once

#include "equilibrium/newton.hpp"
#include "equilibrium/options.hpp"
#include "equilibrium/relaxation.hpp"
#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

#include <grainlaw/grainlaw.h>

#include <vector>

namespace grainlaw::core {

// All memory of one solving thread.
template <int D>
struct Workspace {
  Increment<D> increment;
  Increment<D> detour;  // what sub-increments or an advancing history led to, while less is tried
  RelaxationMemory<D> relaxation;
  ReferenceMemory reference;
  NewtonMemory<D> newton;
  Sensitivity<D> sensitivity;
  std::vector<double> guess;
  std::vector<double> move;  // of the last part with drag
};

// What is tried: all that may help; no parts, where they would ask for the same as the whole; of that only
// committed or only advancing history, where the caller takes smaller steps between the two.
enum class Trying { all, whole, committed, advancing };

template <int D>
struct Request {
  const Problem<D>* problem = nullptr;
  const SolverOptions* options = nullptr;
  const Configuration<D>* from = nullptr;
  Tensor<D> deformation{};  // F to reach, without rotation against `from`
  double tolerance = 1e-6;
  double loose_tolerance = 0;  // as in SolverOptions, of this request
  double duration = 1;         // of the increment, that of an ordinary one being 1 [-]
  Trying trying = Trying::all;
  bool sensitivities = false;
  // Coordinates (rotations counted from `from`) to start the iteration from, at guess_deformation;
  // null: the affine image.
  const std::vector<double>* guess = nullptr;
  Tensor<D> guess_deformation{};
  // As Outcome::loose and history_advanced of the trial it comes from.
  bool guess_loose = false;
  bool guess_advanced = false;
};

struct Outcome {
  grainlaw_status status = GRAINLAW_NOT_CONVERGED;
  int subincrements = 1;  // that this is the end of, each from the equilibrium of the one before
  bool history_advanced = false;  // approximate: friction history advanced during the relaxation
  bool loose = false;             // ended at the loose tolerance: close to an equilibrium, none
  bool sensitivities = false;     // they exist, and belong to where this ended
  double step_ratio = 1;
};

}  // namespace grainlaw::core

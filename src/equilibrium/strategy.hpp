// From an increment of deformation to its equilibrium: which solver, in which order, and what to do
// when one fails.
#pragma once

#include "equilibrium/newton.hpp"
#include "equilibrium/options.hpp"
#include "equilibrium/relaxation.hpp"
#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

#include <grainlaw/grainlaw.h>

#include <array>
#include <vector>

namespace grainlaw {

// All memory of one solving thread.
struct Workspace {
  Increment increment;
  Increment detour;  // what sub-increments or an advancing history led to, while less is tried
  RelaxationMemory relaxation;
  NewtonMemory newton;
  Sensitivity sensitivity;
  std::vector<double> guess;
};

struct Request {
  const Problem* problem = nullptr;
  const SolverOptions* options = nullptr;
  const Configuration* from = nullptr;
  std::array<double, 4> deformation{};  // F to reach, without rotation against `from`
  double tolerance = 1e-6;
  double loose_tolerance = 0;  // as in SolverOptions, of this request
  bool sensitivities = false;
  // Coordinates (rotations counted from `from`) to start the iteration from, at guess_deformation;
  // null: the affine image.
  const std::vector<double>* guess = nullptr;
  std::array<double, 4> guess_deformation{};
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

// On success workspace.increment holds the equilibrium, its history not yet advanced.
Outcome solve(const Request& request, Workspace& workspace);

// The published servo for frames (Liu, Bosco & Suiker 2017, Tables 2 and 3), in servo.cpp: boundary
// nodes are moved by gain x residual between relaxations of the inner particles.
bool solve_servo(Increment& increment, const SolverOptions& options, double tolerance,
                 RelaxationMemory& memory);

}  // namespace grainlaw

// Request for an equilibrium, its outcome, and the memory of the solution.
#pragma once

#include "equilibrium/newton.hpp"
#include "equilibrium/options.hpp"
#include "equilibrium/relaxation.hpp"
#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

#include <grainlaw/grainlaw.h>

#include <span>
#include <vector>

namespace grainlaw::core {

// All memory of one solving thread.
template <int D>
struct Workspace {
  Increment<D> increment;
  Increment<D> detour;  // end of sub-increments or advancing history, while the whole is tried
  RelaxationMemory<D> relaxation;
  ReferenceMemory reference;
  NewtonMemory<D> newton;
  Sensitivity<D> sensitivity;
  std::vector<double> guess, guess_step;
  std::vector<double> velocity;       // of the Configuration at the end of the last part
  std::vector<unsigned char> loaded;  // nodes that bear, while the report counts them
};

// Stages to try: all; or those of the whole increment alone, without parts. committed and advancing
// restrict `whole` to one kind of history, for callers that cut the step between the two.
enum class Trying { all, whole, committed, advancing };

// Duration of an increment that its strain sets.
inline constexpr double by_strain = -1;

template <int D>
struct Request {
  const Problem<D>* problem = nullptr;
  const SolverOptions* options = nullptr;
  const Configuration<D>* from = nullptr;
  Tensor<D> deformation{};  // F to reach, without its rotation relative to `from`
  std::array<double, Dimension<D>::spins> turn{};  // that rotation [rad]
  double tolerance = 1e-6;
  double loose_tolerance = 0;   // for this request, see SolverOptions
  double duration = by_strain;  // of the increment [memories; with inertia s]
  Trying trying = Trying::all;
  bool sensitivities = false;
  // Coordinates at guess_deformation from which the iteration starts, rotations relative to `from`.
  // Null: the affine image.
  const std::vector<double>* guess = nullptr;
  Tensor<D> guess_deformation{};
  // From there to `deformation`: fluctuations of the nodes (component-major). Empty: none.
  std::span<const double> guess_step{};
  // Outcome::loose and Outcome::history_advanced of the trial that the guess comes from.
  bool guess_loose = false;
  bool guess_advanced = false;
};

struct Outcome {
  grainlaw_status status = GRAINLAW_NOT_CONVERGED;
  int subincrements = 1;          // number of parts, each from the equilibrium of the one before
  bool history_advanced = false;  // approximate: the relaxation advanced the friction history
  bool loose = false;             // ended at the loose tolerance, not at an equilibrium
  bool sensitivities = false;     // they exist and belong to this end
  double step_ratio = 1;
};

}  // namespace grainlaw::core

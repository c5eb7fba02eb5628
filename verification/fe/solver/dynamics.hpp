// Explicit dynamics with lumped masses (thesis eqs. 4.14-4.20): central differences.
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

struct DynamicsOptions {
  double duration = 1;   // of the run [s]
  double density = 0;    // mass per reference volume [kg/m3]
  double damping = 0;    // viscous, proportional to the mass [1/s]
  double time_step = 0;  // [s]; 0: `safety` times the critical step
  // Factor on 2 / omega [-]. omega is the highest frequency of the mesh with the elastic tangents
  // of the last observed step, which bound the packings' stiffness.
  double safety = 0.8;
};

// Starts at rest at F = I. Every time step is one increment of the points, evaluated from the state
// of the last one. A time step that a point refuses is cut. Throws InputError for contradictory
// conditions, ComputationError when F = I cannot be evaluated. advance() throws ComputationError
// for an unstable time step.
std::unique_ptr<Solver> make_dynamics_solver(const Model& model, const Material& material,
                                             const DynamicsOptions& options, int threads);

}  // namespace verification

// Solvers in scene files.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "fe/solver/dynamics.hpp"
#include "fe/solver/newton.hpp"
#include "fe/solver/relaxation.hpp"

namespace verification {

enum class SolverKind { newton, relaxation, dynamics };

struct SolverOptions {
  SolverKind kind = SolverKind::newton;
  NewtonOptions newton;
  RelaxationOptions relaxation;
  DynamicsOptions dynamics;
  int steps = 1;                // load steps of the run
  double particle_density = 0;  // of the grains; 0: the dynamic options give the density [kg/m3]

  // Of the run: 1, or seconds in dynamics.
  [[nodiscard]] double duration() const {
    return kind == SolverKind::dynamics ? dynamics.duration : 1;
  }
};

// Reads `solver` and the table of that name; tables of other solvers are refused as unknown keys.
// Throws InputError.
SolverOptions read_solver(SceneTable& scene, const MaterialSource& material);

// Errors as the solvers have them. The model must outlive the solver.
std::unique_ptr<Solver> make_solver(const SolverOptions& options, const Model& model,
                                    const Material& material, int threads);

}  // namespace verification

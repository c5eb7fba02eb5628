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
  double particle_density = 0;  // density of the grains; 0: from the dynamic options [kg/m3]

  // Duration of the run: 1, or seconds in dynamics.
  [[nodiscard]] double duration() const {
    return kind == SolverKind::dynamics ? dynamics.duration : 1;
  }
};

// Reads `solver` and its table; tables of other solvers are unknown keys. Throws InputError.
SolverOptions read_solver(SceneTable& scene, const MaterialSource& material);

// Makes the solver, which throws as its kind does. `model` must outlive it.
std::unique_ptr<Solver> make_solver(const SolverOptions& options, const Model& model,
                                    const Material& material, int threads);

}  // namespace verification

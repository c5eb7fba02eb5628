// Scenes of `grainlaw solve`.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "fe/output/output_options.hpp"
#include "fe/solver/newton.hpp"

#include <string>

namespace verification {

struct FiniteElementScene {
  std::string name;
  MaterialSource material;
  Model model;
  NewtonOptions newton;
  int threads = 0;      // <= 0: as many as the library takes
  double duration = 1;  // of the run; seconds in dynamic ones
  int steps = 1;
  std::string abscissa;
  OutputOptions output;
};

// Throws InputError that names file, line, key and what was expected.
FiniteElementScene read_fe_scene(const SceneFile& file);

// The solver that the scene asks for. Errors as the solvers have them. The scene must outlive it.
std::unique_ptr<Solver> make_solver(const FiniteElementScene& scene, const Material& material);

}  // namespace verification

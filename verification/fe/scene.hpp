// Scenes of `grainlaw solve`.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "fe/solver.hpp"

#include <string>

namespace verification {

struct FiniteElementScene {
  std::string name;
  MaterialSource material;
  Model model;
  SolverOptions options;
  int steps = 1;
  std::string abscissa;
  int vtk_every = 0;  // particles of the first integration point, every so many steps
};

// Throws InputError that names file, line, key and what was expected.
FiniteElementScene read_fe_scene(const SceneFile& file);

}  // namespace verification

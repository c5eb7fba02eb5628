// Scenes of `grainlaw solve`.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "fe/output/output_options.hpp"
#include "fe/output/probe.hpp"
#include "fe/prestress.hpp"
#include "fe/solver/cycle.hpp"
#include "fe/solver/solver_scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace verification {

struct FiniteElementScene {
  std::string name;
  MaterialSource material;
  int dimension = 2;               // of material and mesh
  std::vector<Segment> prestress;  // empty: none
  Model model;
  SolverOptions solver;
  std::optional<Cycle> cycle;
  int threads = 0;  // <= 0: the library's default
  int steps = 1;
  std::string abscissa;
  std::vector<DisplacementProbe> probes;
  OutputOptions output;
};

// Reads a scene. Throws InputError that names file, line, key and expectation.
FiniteElementScene read_fe_scene(const SceneFile& file);

}  // namespace verification

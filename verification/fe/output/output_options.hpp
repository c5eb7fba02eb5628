// Outputs of a scene besides its tables.
#pragma once

#include "app/scene.hpp"
#include "fe/mesh/mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace verification {

// Options of outputs; integration points are numbered from 0, by elements.
struct OutputOptions {
  int checkpoint_every = 0;              // load steps; 0: only at an interrupt
  int vtk_every = 0;                     // load steps; 0: never
  std::vector<std::size_t> packings;     // points whose particles are written
  std::vector<std::size_t> points;       // with a table of their own
  std::vector<std::string> every_point;  // fields with a table over all points
  bool point_costs = false;              // the time of all points has one too
  struct Pictures {
    std::vector<std::string> fields;    // drawn on the mesh
    std::vector<std::size_t> packings;  // points whose particles and force chains are drawn
    std::vector<std::string> extremes;  // fields whose extreme points are drawn too
    std::vector<int> steps;
  } pictures;
};

// Reads checkpoint_every, vtk_every, packings, points, every_point and the table picture. Throws
// InputError.
OutputOptions read_output(SceneTable& scene, const Mesh& mesh, int steps);

}  // namespace verification

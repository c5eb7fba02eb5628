// What a scene wants to be written beside its tables.
#pragma once

#include "app/scene.hpp"
#include "fe/mesh/mesh.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace verification {

// Integration points are numbered from 0, element by element.
struct OutputOptions {
  int checkpoint_every = 0;              // load steps; 0: only when the run is interrupted
  int vtk_every = 0;                     // load steps; 0: never
  std::vector<std::size_t> packings;     // points whose particles are in the series
  std::vector<std::size_t> points;       // with a table of their own
  std::vector<std::string> every_point;  // fields with a table of all points
  struct Pictures {
    std::vector<std::string> fields;    // of the mesh
    std::vector<std::size_t> packings;  // points whose particles and force chains are drawn
    std::vector<std::string>
        extremes;  // fields: so are the points where they are least and largest
    std::vector<int> steps;
  } pictures;
};

// Keys checkpoint_every, vtk_every, packings, points, every_point and the table picture. Throws InputError.
OutputOptions read_output(SceneTable& scene, const Mesh& mesh, int steps);

}  // namespace verification

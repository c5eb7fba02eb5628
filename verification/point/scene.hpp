// Scenes of `grainlaw point`: one path, or one per case.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "point/driver.hpp"
#include "point/path.hpp"

#include <string>
#include <vector>

namespace verification {

struct PointScene {
  std::string name;  // name of the results
  MaterialSource material;
  int dimension = 2;  // 2: discs, 3: spheres
  PointOptions options;
  std::vector<Segment> segments;
  std::string abscissa;
  int vtk_every = 0;
  std::vector<double> pictures;    // abscissae of pictures of the particles, increasing [-]
  double picture_force = 0;        // force of a bar one mean radius wide [N]; 0: see draw_snapshots
  bool particle_measures = false;  // also write NAME_particles.csv
  bool figure = true;              // draw the history
  std::vector<std::string> figures;  // further figures of path_figures
  bool shear = false;                // the figures are those of a simple shear
  bool may_end = false;              // an early end is a result, not a failure
};

// Reads a scene: one path, or one per [[case]], whose keys are merged over the scene's. Results are
// named SCENE_CASE, with CASE the key `name`. Throws InputError.
std::vector<PointScene> read_point_scenes(const SceneFile& file);

}  // namespace verification

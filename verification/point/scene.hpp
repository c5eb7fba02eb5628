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
  std::string name;  // of the results
  MaterialSource material;
  int dimension = 2;  // 2: discs, 3: spheres
  PointOptions options;
  std::vector<Segment> segments;
  std::string abscissa;
  int vtk_every = 0;
  std::vector<double> pictures;  // abscissae from which on the particles are drawn, increasing [-]
  double picture_force = 0;      // whose bar is a mean radius wide [N]; 0: see draw_snapshots
  bool particle_measures = false;    // also write NAME_particles.csv
  bool figure = true;                // draw the history
  std::vector<std::string> figures;  // of path_figures, drawn too
  bool shear = false;                // of them: a simple shear
  bool may_end = false;              // a path that ends early is a result, not a failure
};

// A scene without [[case]] is one path. Otherwise every [[case]] is one: the scene with the keys of
// the case laid over it, tables merged and all else replaced. Its results are SCENE_CASE, where
// CASE is the key `name` of the case. Throws InputError.
std::vector<PointScene> read_point_scenes(const SceneFile& file);

}  // namespace verification

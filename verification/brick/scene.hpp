// Scenes of `grainlaw solve` whose material consists of spheres.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "brick/newton.hpp"

#include <string>

namespace verification {

struct BrickScene {
  std::string name;
  MaterialSource material;
  BrickModel model;
  BrickNewtonOptions newton;
  int steps = 1;
  int threads = 0;
  std::string abscissa;
};

// Reads the keys of plane scenes that bricks support: steps, threads, abscissa, [mesh] size and
// divisions of three numbers, [newton], [[displacement]], [[tie]] and [[pressure]] with constant
// values. Throws InputError.
BrickScene read_brick_scene(const SceneFile& file);

}  // namespace verification

// Scenes of `grainlaw wave`: a pulse runs into a row of representative volumes.
#pragma once

#include "app/material.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace verification {

// The right end moves inwards by amplitude sin(2 pi t / period) for half a period, then stays.
struct Pulse {
  double amplitude = 0;  // [m]
  double period = 0;     // [s]

  [[nodiscard]] double at(double time) const;
};

// One run and its meshes.
struct WaveCase {
  std::string name;
  MaterialSource material;
  std::size_t repeat = 1;  // representative volumes along x
  Pulse pulse;
  double duration = 0;           // [s]
  double time_step = 0;          // of the particles [s]
  std::size_t rows = 400;        // of the tables
  std::vector<double> sections;  // where displacements are taken, from the right end [m]
  std::vector<std::array<double, 2>> windows;  // of the stress on the top, from the right end [m]
  std::vector<int> divisions;                  // of the meshes along x
  double mesh_time_step = 0;     // of the finest; others in proportion to their elements [s]
  double agitation_damping = 0;  // see WaveMotion [1/s]
  int threads = 0;               // of the meshes; 0: all processors
};

struct WaveScene {
  std::string name;
  std::vector<WaveCase> cases;
};

// Throws InputError.
WaveScene read_wave_scene(const SceneFile& file);

}  // namespace verification

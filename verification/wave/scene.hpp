// Scenes of `grainlaw wave`: a pulse enters a row of representative volumes.
#pragma once

#include "app/material.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace verification {

// Displacement of the right end, inwards: amplitude sin(2 pi t / period) for half a period, then
// constant.
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
  double duration = 0;                         // [s]
  double time_step = 0;                        // time step of the particles [s]
  std::size_t rows = 400;                      // rows of the tables
  std::vector<double> sections;                // places of displacements, from the right end [m]
  std::vector<std::array<double, 2>> windows;  // of the stress on the top, from the right end [m]
  std::vector<int> divisions;                  // of the meshes along x
  double mesh_time_step = 0;     // of the finest mesh; others in proportion to their elements [s]
  double agitation_damping = 0;  // rate, see AgitationDamping [1/s]
  int threads = 0;               // of the meshes; 0: all processors
};

struct WaveScene {
  std::string name;
  std::vector<WaveCase> cases;
};

// Reads a scene. Throws InputError.
WaveScene read_wave_scene(const SceneFile& file);

}  // namespace verification

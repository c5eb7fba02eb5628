// Scenes of `grainlaw dns`: a specimen of repeated frames under stress and strain on its sides.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace verification {

// Target of one component of F or P in a segment, reached linearly from its value at the start.
struct SpecimenTarget {
  enum class Kind {
    keep_deformation,  // F does not change
    deformation,       // F reaches this value [-]
    stretch,           // F reaches this multiple of its start; diagonal components only [-]
    keep_stress,       // P does not change, F is found
    stress             // P reaches this value [Pa], F is found
  };
  Kind kind = Kind::keep_deformation;
  double value = 0;

  [[nodiscard]] bool finds_deformation() const {
    return kind == Kind::keep_stress || kind == Kind::stress;
  }
};

struct SpecimenSegment {
  std::array<SpecimenTarget, 4> target;  // 11, 12, 21, 22
  int steps = 1;
};

struct SpecimenScene {
  std::string name;
  MaterialSource material;          // material of the repeated frame
  std::array<int, 2> repeat{1, 1};  // columns, rows
  toml::table sides;                // rules of left, right, bottom, top, as in a material file
  // Initial Cauchy stress, reached in ten increments [Pa]; F is found for every given component.
  std::array<std::optional<double>, 4> start;
  std::vector<SpecimenSegment> segments;
  int max_cuts = grainlaw_march_options_default().max_cuts;
  bool may_end = false;          // an early end is a result, not a failure
  std::vector<double> pictures;  // axial strains since the start, increasing [-]
  double picture_force = 0;      // force of a bar one mean radius wide [N]; 0: see draw_snapshots
  int vtk_every = 0;             // steps; 0: never
};

// Reads a scene: one specimen, or one per [[case]], whose keys are merged over the scene's. Results
// are named SCENE_CASE, with CASE the key `name`. Throws InputError that names file, line, key and
// expectation.
std::vector<SpecimenScene> read_specimen_scenes(const SceneFile& file);

}  // namespace verification

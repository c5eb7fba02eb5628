// Scenes of `grainlaw dns`: a specimen of repeated frames under stress and strain on its sides.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace verification {

// How one component of F or of P is led through a segment, linearly from its value at the start.
struct SpecimenTarget {
  enum class Kind {
    keep_deformation,  // F stays
    deformation,       // to this F [-]
    stretch,           // to this multiple of F at the start, diagonal components only [-]
    keep_stress,       // P stays, F is found
    stress             // to this P [Pa], F is found
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
  MaterialSource material;          // of the frame that is repeated: contact law, solver
  std::array<int, 2> repeat{1, 1};  // columns, rows
  toml::table sides;                // left, right, bottom, top, as in a material file
  // Cauchy stress that the specimen is brought to first, in ten increments; F is found wherever one
  // is given [Pa].
  std::array<std::optional<double>, 4> start;
  std::vector<SpecimenSegment> segments;
  int max_cuts = 10;             // halvings of one step, at most
  bool may_end = false;          // a path that ends early is a result, not a failure
  std::vector<double> pictures;  // axial strains since the start, increasing [-]
  double picture_force = 0;      // whose bar is a mean radius wide [N]; 0: see draw_snapshots
  int vtk_every = 0;             // steps; 0: never
};

// A scene without [[case]] is one specimen. Otherwise every [[case]] is one: the scene with the keys
// of the case laid over it, tables merged and all else replaced. Its results are SCENE_CASE, where
// CASE is the key `name` of the case. Throws InputError that names file, line, key and what was
// expected.
std::vector<SpecimenScene> read_specimen_scenes(const SceneFile& file);

}  // namespace verification

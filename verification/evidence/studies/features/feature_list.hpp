// The features whose cost is measured: each a material with it beside the same without it.
#pragma once

#include "evidence/studies/features/cost.hpp"
#include "evidence/studies/study.hpp"

#include <string>
#include <vector>

namespace verification::features {

template <int D>
struct Feature {
  std::string name;
  MaterialSource with, without;
  std::vector<Increment<D>> path;
  Usage use;  // with it; without it nothing is used
};

// Particles, tolerance and drag of all of them.
struct Setting {
  int count = 400;
  double tolerance = 1e-6;
  double viscous_number = 0;
};

// Discs have boundaries, too.
std::vector<Feature<2>> of_discs(const StudyOptions& options, const Setting& setting);
std::vector<Feature<3>> of_spheres(const StudyOptions& options, const Setting& setting);

}  // namespace verification::features

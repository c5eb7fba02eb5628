// The packings and paths of the study of spheres, and its parts.
#pragma once

#include "evidence/studies/study.hpp"

#include <grainlaw/grainlaw.hpp>

#include <array>
#include <vector>

namespace verification::spheres {

using Tensor3 = std::array<double, 9>;
using Tangent3 = std::array<double, 81>;

constexpr double increment = 0.001;

// Spheres compacted here, with the frictional law of YADE's 500 spheres. Throws grainlaw::Error.
grainlaw::Material packed(int count, double viscous_number, double tolerance, int seed = 1);

// After so many increments, which need not be whole, of triaxial compression or of simple shear.
Tensor3 deformation_after(double increments, bool shear = false);

// Exact tangents against central differences at so many states of both paths.
void check_tangents(const StudyOptions& options, int states);
// Stress error against CPU time, of YADE's spheres (seed 0) or of as many compacted here; a step of
// YADE takes yade_step [ns] a sphere. Errors are also measured against a path in increments so many
// times finer (0: not).
void measure_error(const StudyOptions& options, int seed, double yade_step, int finer_parts);
// CPU time and memory over the number, of so many increments.
void measure_cost(const StudyOptions& options, const std::vector<int>& counts, int increments);

}  // namespace verification::spheres

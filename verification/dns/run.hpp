// One scene of `grainlaw dns` from start to end, with its table, pictures and cost.
#pragma once

#include "dns/specimen.hpp"

namespace verification {

// Writes stem.csv, .svg, .png, stem_cost.csv, the specimen, and what the scene asks for beside them.
// Throws InputError, and ComputationError when there is no equilibrium at the start.
SpecimenEnd run_specimen(const SpecimenScene& scene, const std::filesystem::path& stem);

}  // namespace verification

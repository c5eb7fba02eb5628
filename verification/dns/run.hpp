// Run of one scene of `grainlaw dns`, with its table, pictures and cost.
#pragma once

#include "dns/specimen.hpp"

namespace verification {

// Writes stem.csv, .svg, .png, stem_cost.csv, the specimen, and the outputs that the scene asks
// for; prints cost and files. A path that ends early, or is interrupted, keeps its results so far.
// Throws InputError, Interrupted, and ComputationError without an equilibrium at the start or where
// the scene does not allow an early end.
SpecimenEnd run_specimen(const SpecimenScene& scene, const std::filesystem::path& stem);

}  // namespace verification

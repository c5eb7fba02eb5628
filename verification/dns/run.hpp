// One scene of `grainlaw dns` from start to end, with its table, pictures and cost.
#pragma once

#include "dns/specimen.hpp"

namespace verification {

// Writes stem.csv, .svg, .png, stem_cost.csv, the specimen, and what the scene asks for beside them,
// and tells what the run took and wrote. Of a path that ends early, or is asked to, what was reached
// stays written. Throws InputError, Interrupted, ComputationError when there is no equilibrium at the
// start or the scene does not allow for an early end.
SpecimenEnd run_specimen(const SpecimenScene& scene, const std::filesystem::path& stem);

}  // namespace verification

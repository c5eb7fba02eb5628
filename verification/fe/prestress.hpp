// Initial stress of a specimen.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "point/path.hpp"

#include <filesystem>
#include <vector>

namespace verification {

// Reads [[prestress.segment]], with the keys of `grainlaw point` (steps; F11, dF11, P11, sigma11,
// ...). Empty without.
std::vector<Segment> read_prestress(SceneTable& scene, const MaterialSource& material);

// Material whose packing has followed the path; its F = I is that state. Points of a specimen under
// uniform stress are alike, so that one path serves all. Writes stem_prestress_particles.csv and so
// on. Throws InputError, and ComputationError when the stress is not reached.
MaterialSource prestressed(const MaterialSource& source, const std::vector<Segment>& path,
                           const std::filesystem::path& stem);

}  // namespace verification

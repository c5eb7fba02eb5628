// The stress a specimen stands under before its run begins.
#pragma once

#include "app/material.hpp"
#include "app/scene.hpp"
#include "point/path.hpp"

#include <filesystem>
#include <vector>

namespace verification {

// [[prestress.segment]]: as the segments of `grainlaw point` (steps; F11, dF11, P11, sigma11, ...).
// Empty without.
std::vector<Segment> read_prestress(SceneTable& scene, const MaterialSource& material);

// The material whose packing has been led there; its F = I is that state. All points of a specimen
// under uniform stress are alike, so that one of them is led, once. Writes the packing to
// stem_prestress_particles.csv and so on. Throws InputError, and ComputationError when the stress is
// not reached.
MaterialSource prestressed(const MaterialSource& source, const std::vector<Segment>& path,
                           const std::filesystem::path& stem);

}  // namespace verification

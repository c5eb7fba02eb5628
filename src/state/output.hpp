// An equilibrium for others to read: force chains to look at, or a packing to start from.
#pragma once

#include "material/material.hpp"

#include <string>

namespace grainlaw {

// Particles and force chains as one VTK file. Throws Error (FILE_ERROR).
void write_force_chains(const std::string& path, const Material& material, const Configuration& at);

// The packing whose equilibrium at F = I is this one: deformed cell, particles, contact forces.
[[nodiscard]] Packing as_packing(const Material& material, const Configuration& at);

}  // namespace grainlaw

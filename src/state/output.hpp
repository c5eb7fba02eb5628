// An equilibrium as files: force chains for pictures, or a packing to start from.
#pragma once

#include "material/material.hpp"

#include <string>

namespace grainlaw::core {

// Writes particles and force chains as one VTK file. Throws Error (FILE_ERROR).
template <int D>
void write_force_chains(const std::string& path, const Material<D>& material,
                        const Configuration<D>& at);

// The packing whose equilibrium at F = I is this one: deformed cell, particles, contact forces.
template <int D>
[[nodiscard]] Packing as_packing(const Material<D>& material, const Configuration<D>& at);

}  // namespace grainlaw::core

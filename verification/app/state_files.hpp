// Files of a state as the library writes them, none over a file of others.
#pragma once

#include <grainlaw/grainlaw.h>

#include <filesystem>

namespace verification {

// prefix_particles.csv, _contacts.csv and _cell.csv: all of them or none. Throws ComputationError, as
// the others do.
void write_packing(const grainlaw_state* state, const std::filesystem::path& prefix);

// Particles and force chains for ParaView.
void write_vtk(const grainlaw_state* state, const std::filesystem::path& path);
// stem_0010.vtp
void write_vtk(const grainlaw_state* state, const std::filesystem::path& stem, int step);

}  // namespace verification

// A picture of a packing: its map, and of discs the rose diagram of their contact normals.
#pragma once

#include "app/library.hpp"

#include <filesystem>

namespace verification {

// Of a state whose packing was written as stem_particles.csv and so on: stem.svg and stem.png. Returns
// what Svg::write does, and fails as it does.
bool draw_packing(const grainlaw_state* state, const std::filesystem::path& stem);

}  // namespace verification

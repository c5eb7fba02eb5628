// A picture of a packing: its map, and of discs the rose diagram of their contact normals.
#pragma once

#include "app/library.hpp"

#include <filesystem>

namespace verification {

// Draws stem.svg and stem.png of a state. Returns and throws as Svg::write does.
bool draw_packing(const grainlaw_state* state, const std::filesystem::path& stem);

}  // namespace verification

// Picture of a packing: discs, frame, contact forces as bars of proportional width, and the rose
// diagram of contact normals.
#pragma once

#include "pack/written.hpp"

#include <filesystem>
#include <string>

namespace verification {

// Draws stem.svg and stem.png; discs across the sides of a periodic cell are drawn on both. Returns
// and throws as run_gnuplot() does.
bool draw_packing(const WrittenPacking& packing, const std::filesystem::path& stem,
                  const std::string& title);

}  // namespace verification

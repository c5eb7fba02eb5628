// A picture of a packing: its discs, its frame, its contact forces as bars as wide as the force, and
// the rose diagram of its contact normals.
#pragma once

#include "pack/written.hpp"

#include <filesystem>
#include <string>

namespace verification {

// Draws stem.svg and stem.png. With a periodic cell the discs across its sides are drawn again.
// Returns what run_gnuplot does, and fails as it does.
bool draw_packing(const WrittenPacking& packing, const std::filesystem::path& stem,
                  const std::string& title);

}  // namespace verification

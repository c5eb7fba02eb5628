// A picture of a packing: its discs, and its contact forces as bars as wide as the force.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// Reads prefix_particles.csv, prefix_contacts.csv and prefix_cell.csv as the library writes them,
// and draws stem.svg and stem.png. With a periodic cell the discs across its sides are drawn again.
void draw_packing(const std::string& prefix, const std::filesystem::path& stem,
                  const std::string& title);

}  // namespace verification

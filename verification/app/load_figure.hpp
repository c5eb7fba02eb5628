// Load against displacement: what the conditions of a boundary problem exert on the body.
#pragma once

#include "app/csv.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Of the columns CONDITION_displacement [m] and CONDITION_force of a table: stem.svg and stem.png with a
// curve for each of the conditions that moves. Where all of them move against their axis, both are turned
// round, so that a footing that is pressed down has a positive load. `unit` is that of the forces, "N" or
// "N/m". False without a picture.
bool draw_load_figure(const CsvTable& table, const std::vector<std::string>& conditions,
                      const std::string& unit, const std::filesystem::path& stem);

}  // namespace verification

// Load-displacement curves of the conditions of a boundary value problem.
#pragma once

#include "app/csv.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Draws stem.svg and stem.png from columns CONDITION_displacement [m] and CONDITION_force, one
// curve per moving condition. Where all move against their axis, both signs are reversed: a footing
// pressed down has a positive load. `unit` is that of the forces, "N" or "N/m". Returns false
// without a picture.
bool draw_load_figure(const CsvTable& table, const std::vector<std::string>& conditions,
                      const std::string& unit, const std::filesystem::path& stem);

}  // namespace verification

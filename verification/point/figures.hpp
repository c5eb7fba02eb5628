// Figures of soil mechanics for a finished path, from its table.
#pragma once

#include "app/csv.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

inline const std::vector<std::string_view> path_figures{"p-q", "e-log-p", "stress-path"};

// Suffix of a figure's file name: "_p_q".
std::string figure_end(std::string_view name);

// Draws a figure by name; returns false without a picture. p-q: deviatoric stress, or shear stress
// of a shear, against mean pressure. e-log-p: void ratio against the logarithm of mean pressure.
// stress-path: axial against lateral stress, or shear against normal stress on the planes of a
// shear.
bool draw_path_figure(std::string_view name, const CsvTable& table, bool shear,
                      const std::string& title, const std::filesystem::path& stem);

}  // namespace verification

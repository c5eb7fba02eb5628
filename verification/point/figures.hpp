// Pictures that soil mechanics looks at: of a finished path, from its table.
#pragma once

#include "app/csv.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

inline const std::vector<std::string_view> path_figures{"p-q", "e-log-p", "stress-path"};

// What a name of them adds to the name of a result: "_p_q".
std::string figure_end(std::string_view name);

// p-q: axial less lateral stress, or the shear stress of a shear, against the mean pressure; e-log-p: void
// ratio against the logarithm of the mean pressure; stress-path: axial against lateral stress, of a shear
// the shear stress against the normal stress on its planes. Cycles of the abscissa, a column, are told
// apart by colour. False without a picture.
bool draw_path_figure(std::string_view name, const CsvTable& table, bool shear,
                      const std::string& abscissa, const std::filesystem::path& stem);

}  // namespace verification

#include "point/figures.hpp"

#include "app/figure.hpp"
#include "app/stresses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace verification {

std::string figure_end(std::string_view name) {
  std::string end = fmt::format("_{}", name);
  std::replace(end.begin(), end.end(), '-', '_');
  return end;
}

bool draw_path_figure(std::string_view name, const CsvTable& table, bool shear,
                      const std::string& abscissa, const std::filesystem::path& stem) {
  if (table.rows() == 0) return false;
  const Stresses s = stresses_of(table);
  const std::vector<int> cycles = cycles_of(table[abscissa]);
  const auto figure = [](const char* horizontal, const char* vertical, Curve path) {
    const Curve start{"start", {path.x.front()}, {path.y.front()}, colour::orange, Stroke::none, 7};
    Figure result{"", horizontal, {{vertical, {std::move(path), start}, 1.6}}};
    result.room = 0.03;
    return result;
  };
  const auto path = [&](const std::vector<double>& x, const std::vector<double>& y) {
    Curve curve{"", x, y};
    curve.cycles = cycles;
    return curve;
  };
  if (name == "e-log-p") {
    Curve curve;
    for (std::size_t k = 0; k < s.mean.size(); ++k) {
      if (s.mean[k] <= 0) continue;
      curve.x.push_back(s.mean[k]);
      curve.y.push_back(table["void_ratio"][k]);
      if (!cycles.empty()) curve.cycles.push_back(cycles[k]);
    }
    if (curve.x.empty()) return false;
    Figure result = figure("mean pressure p [kPa]", "void ratio e [-]", curve);
    result.logarithmic = true;
    return draw(result, stem);
  }
  const bool stress_path = name == "stress-path";
  if (stress_path && !shear)
    return draw(figure("lateral stress [kPa]", "axial stress [kPa]", path(s.lateral, s.axial)),
                stem);
  return draw(figure(stress_path ? "normal stress [kPa]" : "mean pressure p [kPa]",
                     shear ? "shear stress [kPa]" : "axial less lateral stress q [kPa]",
                     path(stress_path ? s.axial : s.mean, shear ? s.shear : s.deviatoric())),
              stem);
}

}  // namespace verification

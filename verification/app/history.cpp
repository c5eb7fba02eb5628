#include "app/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace verification {

History::History(std::filesystem::path stem)
    : stem_(std::move(stem)), csv_(stem_.string() + ".csv", record_columns()) {}

bool History::draw_figure(const std::string& abscissa, const std::string& title) const {
  return draw_history(read_csv(csv_.path()), abscissa, title, stem_);
}

std::string History::summary(const Effort& unfinished) const {
  return history_summary(read_csv(csv_.path()), unfinished);
}

bool draw_history(const CsvTable& table, const std::string& abscissa, const std::string& title,
                  const std::filesystem::path& stem) {
  if (table.rows() == 0) return false;
  constexpr double percent = 100;
  constexpr double kilopascal = 1e-3;
  const bool shear = abscissa == shear_abscissa;
  const auto column = [&](const char* name, double unit) {
    std::vector<double> values = table[name];
    for (double& value : values) value *= unit;
    return values;
  };
  const auto x = shear ? column("F12", 1) : column("axial_strain", percent);
  const auto normal_1 = column("sigma11", -kilopascal);
  const auto normal_2 = column("sigma22", -kilopascal);
  const auto shear_stress = column("sigma12", kilopascal);
  const auto volumetric = column("volumetric_strain", percent);
  const auto coordination = column("coordination", 1);
  const auto mechanical = column("coordination_no_rattlers", 1);
  Figure figure{title, shear ? "shear F12 [-]" : "axial strain 1 - F22 [%]", {}};
  figure.panels.push_back({"Cauchy stress [kPa]",
                           {{"-σ11", x, normal_1, colour::blue, Stroke::solid},
                            {"-σ22", x, normal_2, colour::orange, Stroke::solid},
                            {"σ12", x, shear_stress, colour::green, Stroke::solid}},
                           1.3,
                           "top left"});
  const auto [least, most] = std::minmax_element(volumetric.begin(), volumetric.end());
  constexpr double isochoric = 1e-9;  // %, below this there is nothing to see
  if (*most - *least > isochoric)
    figure.panels.push_back({"volumetric strain, dilation + [%]",
                             {{"", x, volumetric, colour::blue, Stroke::solid}},
                             1});
  figure.panels.push_back({"coordination [-]",
                           {{"all particles", x, coordination, colour::blue, Stroke::solid},
                            {"without rattlers", x, mechanical, colour::orange, Stroke::dashed}},
                           1});
  return draw(figure, stem);
}

std::string history_summary(const CsvTable& table, const Effort& unfinished) {
  const auto sum = [&](const char* name, double more) {
    const std::vector<double>& values = table[name];
    return std::accumulate(values.begin(), values.end(), more);
  };
  return fmt::format(
      "{:.0f} steps, {:.0f} iterations, {:.0f} evaluations, {:.0f} relaxation steps, "
      "{:.0f} factorisations, {:.0f} cuts, {:.0f} loose, {:.0f} with advanced history",
      table.rows() == 0 ? 0 : table["step"].back(), sum("newton_iterations", unfinished.iterations),
      sum("evaluations", unfinished.evaluations),
      sum("relaxation_steps", static_cast<double>(unfinished.relaxation_steps)),
      sum("factorisations", unfinished.factorisations), sum("step_cuts", unfinished.cuts),
      sum("loose_parts", unfinished.loose), sum("history_advanced", unfinished.history_advanced));
}

void write_vtk(const grainlaw_state* state, const std::filesystem::path& stem, int step) {
  const std::string path = fmt::format("{}_{:04d}.vtp", stem.string(), step);
  check(grainlaw_state_write_vtk(state, path.c_str()), "writing " + path);
}

}  // namespace verification

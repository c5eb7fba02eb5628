#include "app/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace verification {

History::History(std::filesystem::path stem)
    : stem_(std::move(stem)), csv_(stem_.string() + ".csv", record_columns()) {}

void History::add(const Record& record) {
  csv_.row(record_values(record));
  records_.push_back(record);
}

void History::draw_figure(const std::string& abscissa, const std::string& title) const {
  constexpr double percent = 100;
  constexpr double kilopascal = 1e-3;
  const bool shear = abscissa == shear_abscissa;
  std::vector<double> x, normal_1, normal_2, shear_stress, volumetric, coordination, mechanical;
  for (const Record& record : records_) {
    x.push_back(shear ? record.deformation(0, 1) : percent * record.axial_strain());
    normal_1.push_back(-kilopascal * record.cauchy(0, 0));
    normal_2.push_back(-kilopascal * record.cauchy(1, 1));
    shear_stress.push_back(kilopascal * record.cauchy(0, 1));
    volumetric.push_back(percent * record.volumetric_strain());
    coordination.push_back(record.coordination);
    mechanical.push_back(record.coordination_no_rattlers);
  }
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
  draw(figure, stem_);
}

std::string History::summary() const {
  Effort sum;
  long iterations = 0, evaluations = 0, factorisations = 0;
  for (const Record& record : records_) {
    iterations += record.effort.iterations;
    evaluations += record.effort.evaluations;
    factorisations += record.effort.factorisations;
    sum.relaxation_steps += record.effort.relaxation_steps;
    sum.cuts += record.effort.cuts;
    sum.loose += record.effort.loose;
    sum.history_advanced += record.effort.history_advanced;
  }
  return fmt::format(
      "{} steps, {} iterations, {} evaluations, {} relaxation steps, {} factorisations, {} cuts, "
      "{} loose, {} with advanced history",
      records_.empty() ? 0 : records_.back().step, iterations, evaluations, sum.relaxation_steps,
      factorisations, sum.cuts, sum.loose, sum.history_advanced);
}

void write_vtk(const grainlaw_state* state, const std::filesystem::path& stem, int step) {
  const std::string path = fmt::format("{}_{:04d}.vtp", stem.string(), step);
  check(grainlaw_state_write_vtk(state, path.c_str()), "writing " + path);
}

}  // namespace verification

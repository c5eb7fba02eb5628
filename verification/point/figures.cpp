#include "point/figures.hpp"

#include "app/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace verification {
namespace {

constexpr double kilopascal = 1e-3;

// Stresses in kPa, compression positive.
struct Stresses {
  std::vector<double> axial, lateral, shear, mean;
};

Stresses stresses_of(const CsvTable& table) {
  const bool spheres =
      std::find(table.names.begin(), table.names.end(), "sigma33") != table.names.end();
  const auto& axial = table[spheres ? "sigma33" : "sigma22"];
  const auto& shear = table[spheres ? "sigma13" : "sigma12"];
  const auto& first = table["sigma11"];
  const auto& second = table["sigma22"];
  Stresses s;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const double lateral = spheres ? 0.5 * (first[k] + second[k]) : first[k];
    s.axial.push_back(-kilopascal * axial[k]);
    s.lateral.push_back(-kilopascal * lateral);
    s.shear.push_back(kilopascal * shear[k]);
    s.mean.push_back((s.axial.back() + (spheres ? 2 : 1) * s.lateral.back()) / (spheres ? 3 : 2));
  }
  return s;
}

}  // namespace

std::string figure_end(std::string_view name) {
  std::string end = fmt::format("_{}", name);
  std::replace(end.begin(), end.end(), '-', '_');
  return end;
}

bool draw_path_figure(std::string_view name, const CsvTable& table, bool shear,
                      const std::string& title, const std::filesystem::path& stem) {
  if (table.rows() == 0) return false;
  const Stresses s = stresses_of(table);
  std::vector<double> q;
  for (std::size_t k = 0; k < s.axial.size(); ++k)
    q.push_back(shear ? s.shear[k] : s.axial[k] - s.lateral[k]);
  const std::string ordinate = shear ? "shear stress [kPa]" : "axial less lateral stress q [kPa]";
  const auto figure = [&](const char* abscissa, std::string text, const std::vector<double>& x,
                          const std::vector<double>& y) {
    Figure result{title, abscissa, {{std::move(text), {{"", x, y}}, 1.6}}};
    result.panels[0].curves.push_back(
        {"start", {x.front()}, {y.front()}, colour::orange, Stroke::none, 7});
    result.room = 0.03;
    return result;
  };
  if (name == "e-log-p") {
    std::vector<double> p, e;
    for (std::size_t k = 0; k < s.mean.size(); ++k)
      if (s.mean[k] > 0) {
        p.push_back(s.mean[k]);
        e.push_back(table["void_ratio"][k]);
      }
    if (p.empty()) return false;
    Figure result = figure("mean pressure p [kPa]", "void ratio e [-]", p, e);
    result.logarithmic = true;
    return draw(result, stem);
  }
  if (name == "stress-path")
    return draw(shear ? figure("normal stress [kPa]", ordinate, s.axial, q)
                      : figure("lateral stress [kPa]", "axial stress [kPa]", s.lateral, s.axial),
                stem);
  return draw(figure("mean pressure p [kPa]", ordinate, s.mean, q), stem);
}

}  // namespace verification

// Figure 6: the stress ratio in every integration point of a mesh.

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double marked_strain =
    0.09;  // where the points with the highest and lowest ratio are told

// Curves of all points; `last` gets their spread at the largest marked strain.
Panel panel_of(PaperStudy& study, const char* mesh, Table& table, double& last) {
  Panel panel{fmt::format("stress ratio, {} [-]", mesh)};
  const std::string name = std::string("biaxial_") + mesh;
  const auto path = study.results / (name + "_every_stress_ratio.csv");
  const auto run = load_biaxial(study, name);
  if (!run || !std::filesystem::exists(path)) return panel;
  const CsvTable points = read_csv(path);
  const std::size_t rows = std::min(points.rows(), run->strain.size());
  const std::vector<double> strain(run->strain.begin(),
                                   run->strain.begin() + static_cast<std::ptrdiff_t>(rows));
  std::vector<std::vector<double>> ratios;
  for (std::size_t p = 1; p < points.columns.size(); ++p)  // after the step
    ratios.emplace_back(points.columns[p].begin(),
                        points.columns[p].begin() + static_cast<std::ptrdiff_t>(rows));
  for (std::size_t p = 0; p < ratios.size(); ++p)
    panel.curves.push_back(
        {p == 0 ? "single points" : "", strain, ratios[p], colour::grey, Stroke::thin});
  const auto marked = static_cast<std::size_t>(
      std::upper_bound(strain.begin(), strain.end(), marked_strain + 1e-9) - strain.begin() - 1);
  const auto [low, high] =
      std::minmax_element(ratios.begin(), ratios.end(),
                          [&](const auto& a, const auto& b) { return a[marked] < b[marked]; });
  panel.curves.push_back(
      {fmt::format("highest at {:.1f} %", 100 * strain[marked]), strain, *high, colour::orange});
  panel.curves.push_back(
      {fmt::format("lowest at {:.1f} %", 100 * strain[marked]), strain, *low, colour::sky});
  panel.curves.push_back(
      {"of the mean stress",
       strain,
       {run->ratio.begin(), run->ratio.begin() + static_cast<std::ptrdiff_t>(rows)},
       colour::black});
  std::vector<double> spreads;
  for (const double wanted : {0.02, 0.04, 0.06, 0.09}) {
    const auto k = static_cast<std::size_t>(
        std::upper_bound(strain.begin(), strain.end(), wanted + 1e-9) - strain.begin() - 1);
    if (strain[k] < wanted - 0.003) continue;
    std::vector<double> at;
    for (const auto& ratio : ratios) at.push_back(ratio[k]);
    const auto [least, most] = std::minmax_element(at.begin(), at.end());
    spreads.push_back(*most - *least);
    table.row({mesh, strain[k], run->ratio[k], *least, *most, *most - *least});
  }
  if (!spreads.empty()) last = spreads.back();
  if (spreads.size() > 1)
    study.facts.add(fmt::format("points.{}.spread_growth", mesh), spreads.back() / spreads.front());
  return panel;
}

}  // namespace

void draw_points(PaperStudy& study) {
  Table table(
      "Figure 6: stress ratio in the integration points",
      {"mesh", "strain[-]", "of_the_mean_stress[-]", "lowest[-]", "highest[-]", "spread[-]"});
  Figure figure{"Fig. 6: stress ratio in every integration point", "axial strain [-]", {}};
  std::vector<double> spreads;
  for (const char* mesh : {"2x4", "4x8"}) {
    double spread = std::nan("");
    const Panel panel = panel_of(study, mesh, table, spread);
    if (!panel.curves.empty()) figure.panels.push_back(panel);
    spreads.push_back(spread);
  }
  study.facts.add("points.4x8_over_2x4", spreads.back() / spreads.front());
  if (figure.panels.empty()) return;
  draw(figure, study.results / "figure_06");
  table.print();
  table.write(study.results / "points.csv");
}

}  // namespace verification

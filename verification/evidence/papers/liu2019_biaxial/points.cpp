// Figure 6: the stress ratio in every integration point of a mesh.

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
  if (strain[marked] > marked_strain - 0.003)
    study.facts.add(fmt::format("points.{}.highest_over_lowest", mesh),
                    (*high)[marked] / (*low)[marked]);
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

// Largest over mean increment of the deviatoric strain, in the last step to a strain.
double localisation(const PaperStudy& study, const std::string& name, double until) {
  const auto path = study.results / (name + "_every_deviatoric_strain.csv");
  const auto run = load_biaxial(study, name);
  if (!run || !std::filesystem::exists(path)) return std::nan("");
  const CsvTable points = read_csv(path);
  std::size_t k = std::min(points.rows(), run->strain.size()) - 1;
  while (k > 1 && run->strain[k] > until + 1e-9) --k;
  double most = 0, sum = 0;
  for (std::size_t p = 1; p < points.columns.size(); ++p) {
    const double increment = std::abs(points.columns[p][k] - points.columns[p][k - 1]);
    most = std::max(most, increment), sum += increment;
  }
  return most * static_cast<double>(points.columns.size() - 1) / sum;
}

// On both meshes at the last strain that both reach.
void compare_localisation(PaperStudy& study) {
  const auto coarse = load_biaxial(study, "biaxial_2x4"), fine = load_biaxial(study, "biaxial_4x8");
  if (!coarse || !fine) return;
  const double until = std::min(coarse->strain.back(), fine->strain.back());
  study.facts.add("points.increment_at", until);
  study.facts.add("points.increment_4x8_over_2x4", localisation(study, "biaxial_4x8", until) /
                                                       localisation(study, "biaxial_2x4", until));
}

// Eq. 40: the angle by the ratio of the principal stresses, tan^2(45 + phi / 2), less the arcsine of
// the stress ratio, over a test.
void friction_angle(PaperStudy& study) {
  const auto run = study.run("biaxial_2x4");
  if (!run) return;
  double apart = 0;
  for (std::size_t k = 0; k < run->steps(); ++k) {
    const double s1 = -run->history["sigma22"][k], s3 = -run->history["sigma11"][k];
    const double angle = 2 * std::atan(std::sqrt(s1 / s3)) - 0.5 * std::numbers::pi;
    apart = std::max(apart, std::abs(angle - std::asin((s1 - s3) / (s1 + s3))));
  }
  study.facts.add("biaxial_2x4.arcsine_less_angle", apart);
}

// Both published methods together against Newton's method, one element to 0.6 %.
void published_methods(PaperStudy& study) {
  const auto published = load_biaxial(study, "published_explicit"),
             newton = load_biaxial(study, "published_newton");
  if (!published || !newton) return;
  study.facts.add("published.until", published->strain.back());
  study.facts.add(
      "published.ratio_apart",
      std::abs(published->ratio.back() / newton->ratio_at(published->strain.back()) - 1));
}

}  // namespace

void draw_points(PaperStudy& study) {
  compare_localisation(study);
  friction_angle(study);
  published_methods(study);
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

// Figures 15 and 17: what single points of the specimen go through, and which lose their strength.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double percent = 100;
constexpr double failed_below = 1e3;  // mean stress, a hundredth of the lateral pressure [Pa]

// Values of a field, all points over all steps.
struct Fields {
  CsvTable strain, volume, mean, deviator, fabric;

  [[nodiscard]] std::size_t points() const { return strain.columns.size() - 1; }
};

std::optional<Fields> load_fields(const std::filesystem::path& results, const std::string& name) {
  std::array<std::optional<CsvTable>, 5> tables;
  constexpr std::array<const char*, 5> fields{"deviatoric_strain", "volumetric_strain",
                                              "mean_stress", "deviatoric_stress",
                                              "fabric_intensity"};
  for (std::size_t k = 0; k < fields.size(); ++k) {
    tables[k] = load_every(results, name, fields[k]);
    if (!tables[k] || tables[k]->rows() < 3) return std::nullopt;
  }
  return Fields{*tables[0], *tables[1], *tables[2], *tables[3], *tables[4]};
}

std::vector<double> scaled(const CsvTable& table, std::size_t point, double factor) {
  std::vector<double> values = table.columns[point + 1];
  for (double& value : values) value *= factor;
  return values;
}

// Points with the least and the largest last value of a field.
std::array<std::size_t, 2> extremes(const CsvTable& table) {
  std::array<std::size_t, 2> found{0, 0};
  for (std::size_t p = 0; p + 1 < table.columns.size(); ++p) {
    const double value = table.columns[p + 1].back();
    if (value < table.columns[found[0] + 1].back()) found[0] = p;
    if (value > table.columns[found[1] + 1].back()) found[1] = p;
  }
  return found;
}

void draw_points(HierarchicalStudy& study, const std::string& name, const Fields& f) {
  const auto [outside, inside] = extremes(f.strain);
  const std::size_t edge = extremes(f.volume)[1];
  const std::array<std::pair<std::size_t, std::string>, 3> chosen{
      {{outside, "least strained"}, {inside, "most strained"}, {edge, "most dilated"}}};
  const std::array<const char*, 3> colours{colour::blue, colour::orange, colour::green};
  Figure local{"points of " + name, "deviatoric strain [%]", {}};
  Figure paths{"stress paths of points of " + name, "mean stress p [kPa]", {}};
  local.panels = {{"q [kPa]"}, {"fabric intensity [-]"}, {"volumetric strain, dilation + [%]"}};
  paths.panels.push_back({"q [kPa]"});
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto& [point, what] = chosen[k];
    const std::string title = fmt::format("{} (point {})", what, point);
    const auto strain = scaled(f.strain, point, percent);
    const auto q = scaled(f.deviator, point, 1e-3);
    local.panels[0].curves.push_back({title, strain, q, colours[k], Stroke::solid});
    local.panels[1].curves.push_back(
        {"", strain, scaled(f.fabric, point, 1), colours[k], Stroke::solid});
    local.panels[2].curves.push_back(
        {"", strain, scaled(f.volume, point, percent), colours[k], Stroke::solid});
    paths.panels[0].curves.push_back(
        {title, scaled(f.mean, point, 1e-3), q, colours[k], Stroke::solid});
  }
  draw(local, study.results / "figure_15");
  draw(paths, study.results / "figure_15_paths");
  const auto largest = [](std::vector<double> v) { return *std::max_element(v.begin(), v.end()); };
  const auto q_out = scaled(f.deviator, outside, 1e-3);
  const auto strain_out = scaled(f.strain, outside, percent);
  study.facts.agree(
      "15", "outside the band", "unloads after a strain of 2.8 %",
      fmt::format("q {:.0f} kPa at most, {:.0f} kPa at the end; strain {:.1f} % at "
                  "most, {:.1f} % at the end",
                  largest(q_out), q_out.back(), largest(strain_out), strain_out.back()),
      q_out.back() < 0.95 * largest(q_out));
  study.facts.add("15", "inside the band", "60 % strain, dilation 4.5 %",
                  fmt::format("{:.0f} % strain, dilation {:.1f} %",
                              f.strain.columns[inside + 1].back() * percent,
                              f.volume.columns[inside + 1].back() * percent),
                  "not stated");
  study.facts.add("15", "the most dilated point", "dilation 7.4 %, p and q to zero",
                  fmt::format("dilation {:.1f} %, p {:.1f} kPa, q {:.1f} kPa",
                              f.volume.columns[edge + 1].back() * percent,
                              f.mean.columns[edge + 1].back() / 1e3 + 0.0,  // never -0
                              f.deviator.columns[edge + 1].back() / 1e3),
                  "not stated");
}

void draw_failed(HierarchicalStudy& study, const std::string& name, const Fields& f) {
  const auto run = load_run(study.results, name);
  if (!run) return;
  const std::vector<double> strain = run->column("axial_strain", percent);
  std::vector<double> share;
  double first = std::nan("");
  for (std::size_t k = 0; k < f.mean.rows(); ++k) {
    int failed = 0;
    for (std::size_t p = 0; p < f.points(); ++p)
      failed += f.mean.columns[p + 1][k] < failed_below ? 1 : 0;
    share.push_back(percent * failed / static_cast<double>(f.points()));
    if (failed > 0 && !(first >= 0)) first = strain[k];
  }
  draw({"points under less than 1 kPa, " + name,
        "axial strain [%]",
        {{"share of the points [%]", {{"", strain, share, colour::blue, Stroke::solid}}, 1}}},
       study.results / "figure_17");
  study.facts.add("17", "points that have lost their strength", "from 5.3 %, 1.5 % of the points",
                  std::isfinite(first)
                      ? fmt::format("from {:.1f} %, {:.1f} % of the points at {:.1f} %", first,
                                    share.back(), strain.back())
                      : fmt::format("none to {:.1f} %", strain.back()),
                  "not stated");
}

}  // namespace

void study_local_response(HierarchicalStudy& study) {
  for (const std::string name : {"biaxial_10x15", "biaxial_6x10", "biaxial_3x5", "biaxial_2x4"})
    if (const auto fields = load_fields(study.results, name)) {
      draw_points(study, name, *fields);
      draw_failed(study, name, *fields);
      return;
    }
}

}  // namespace verification

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
  CsvTable strain, volume, mean, deviator, fabric, voids;

  [[nodiscard]] std::size_t points() const { return strain.columns.size() - 1; }
};

std::optional<Fields> load_fields(const std::filesystem::path& results, const std::string& name) {
  std::array<std::optional<CsvTable>, 6> tables;
  constexpr std::array<const char*, 6> fields{"deviatoric_strain", "volumetric_strain",
                                              "mean_stress",       "deviatoric_stress",
                                              "fabric_intensity",  "void_ratio"};
  for (std::size_t k = 0; k < fields.size(); ++k) {
    tables[k] = load_every(results, name, fields[k]);
    if (!tables[k] || tables[k]->rows() < 3) return std::nullopt;
  }
  return Fields{*tables[0], *tables[1], *tables[2], *tables[3], *tables[4], *tables[5]};
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
}

constexpr std::size_t per_element = 4;  // points of Q4

// Mean of a field over the points of an element, step by step.
std::vector<double> of_element(const CsvTable& table, std::size_t element) {
  std::vector<double> values(table.rows(), 0.0);
  for (std::size_t k = 0; k < per_element; ++k)
    for (std::size_t step = 0; step < values.size(); ++step)
      values[step] += table.columns[1 + per_element * element + k][step] / per_element;
  return values;
}

// The paper's points 51, 256 and 422 on its mesh of 10 x 15, counted element by element along x; where
// the band leans to the left the mirror image of their elements. The whole element is taken.
void point_facts(HierarchicalStudy& study, const std::string& name, const Fields& f) {
  constexpr std::size_t columns = 10, rows = 15;
  if (f.points() != per_element * columns * rows) return;
  double lean = 0;
  for (std::size_t e = 0; e < columns * rows; ++e)
    lean += of_element(f.strain, e).back() *
            (static_cast<double>(e % columns) - 0.5 * (columns - 1)) *
            (static_cast<double>(e / columns) - 0.5 * (rows - 1));
  for (const std::size_t point : {51, 256, 422}) {
    std::size_t e = point / per_element;
    if (lean < 0) e += columns - 1 - 2 * (e % columns);
    const auto add = [&](const char* fact, double value) {
      study.facts.add(fmt::format(fmt::runtime(fact), name, point), value);
    };
    const auto strain = of_element(f.strain, e), volume = of_element(f.volume, e),
               q = of_element(f.deviator, e), fabric = of_element(f.fabric, e);
    const auto most = [](const std::vector<double>& v) {
      return *std::max_element(v.begin(), v.end());
    };
    add("{}.N{}.strain_most", percent * most(strain));
    add("{}.N{}.dilation_end", percent * volume.back());
    add("{}.N{}.contraction_most", -percent * *std::min_element(volume.begin(), volume.end()));
    add("{}.N{}.p_end", of_element(f.mean, e).back() / 1e3);
    add("{}.N{}.q_end_over_most", q.back() / most(q));
    add("{}.N{}.fabric_end_over_most", fabric.back() / most(fabric));
  }
}

void draw_failed(HierarchicalStudy& study, const std::string& name, const Fields& f) {
  const auto run = load_run(study.results, name);
  if (!run) return;
  const std::vector<double> strain = run->column("axial_strain", percent);
  const auto lost = [](double mean) { return mean < failed_below ? 1.0 : 0.0; };
  const std::size_t elements = f.points() / per_element;
  std::vector<double> points(f.mean.rows(), 0.0), whole = points;
  for (std::size_t p = 0; p < f.points(); ++p)
    for (std::size_t k = 0; k < points.size(); ++k)
      points[k] += percent * lost(f.mean.columns[p + 1][k]) / static_cast<double>(f.points());
  for (std::size_t e = 0; e < elements; ++e) {
    const std::vector<double> mean = of_element(f.mean, e);
    for (std::size_t k = 0; k < whole.size(); ++k)
      whole[k] += percent * lost(mean[k]) / static_cast<double>(elements);
  }
  draw({"points and elements under less than 1 kPa, " + name,
        "axial strain [%]",
        {{"share [%]",
          {{"points", strain, points, colour::blue, Stroke::solid},
           {"elements, mean of their points", strain, whole, colour::orange, Stroke::solid}},
          1}}},
       study.results / "figure_17");
  const auto add = [&](const char* fact, double value) {
    study.facts.add(fmt::format(fmt::runtime(fact), name), value);
  };
  const auto first = std::find_if(points.begin(), points.end(), [](double s) { return s > 0; });
  if (first != points.end())
    add("{}.failed.first_at", strain[static_cast<std::size_t>(first - points.begin())]);
  add("{}.failed.points", points.back());
  add("{}.failed.elements", whole.back());
  // Void ratio of the failed points over that of all points strained more than the mean.
  double strained = 0, failed = 0, count_strained = 0, count_failed = 0, mean_strain = 0;
  for (std::size_t p = 1; p <= f.points(); ++p)
    mean_strain += f.strain.columns[p].back() / static_cast<double>(f.points());
  for (std::size_t p = 1; p <= f.points(); ++p) {
    const double e = f.voids.columns[p].back();
    if (f.strain.columns[p].back() > mean_strain) strained += e, ++count_strained;
    if (f.mean.columns[p].back() < failed_below) failed += e, ++count_failed;
  }
  add("{}.failed.void_ratio_over_mean", (failed / count_failed) / (strained / count_strained));
  const auto largest_fabric = [&](double at) {
    double largest = 0;
    for (std::size_t p = 1; p <= f.points(); ++p)
      largest = std::fmax(largest, interpolate(strain, f.fabric.columns[p], at));
    return largest;
  };
  add("{}.fabric_doubling", largest_fabric(4.8) / largest_fabric(4));
}

}  // namespace

void study_local_response(HierarchicalStudy& study) {
  for (const std::string name : {"biaxial_10x15", "biaxial_6x10", "biaxial_3x5", "biaxial_2x4"})
    if (const auto fields = load_fields(study.results, name)) {
      draw_points(study, name, *fields);
      point_facts(study, name, *fields);
      draw_failed(study, name, *fields);
      return;
    }
}

}  // namespace verification

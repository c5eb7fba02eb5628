// Figures 6 and 7: drained compression of one element against one RVE, and how Newton's method gets to
// the equilibrium of a load step by kind of tangent.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace verification {
namespace {

constexpr double percent = 100;
constexpr double before_peak = 1.8;  // axial strain [%]

struct Kind {
  const char* tangent;
  const char* colour;
  int marker;
};
constexpr std::array<Kind, 3> kinds{
    {{"exact", colour::blue, 7}, {"elastic", colour::orange, 5}, {"perturbed", colour::green, 9}}};
constexpr std::array<double, 2> shown{0.5, 5};  // axial strains of figure 7 [%]

struct Element {
  Kind kind;
  MeshRun run;
  std::vector<double> strain;  // axial [%]
  std::vector<double> stress;  // axial, compression positive [kPa]
  std::vector<double> volume;  // dilation positive [%]
};

std::vector<double> column(const CsvTable& table, const char* name, double factor) {
  std::vector<double> values = table[name];
  for (double& value : values) value *= factor;
  return values;
}

std::optional<Element> load_element(const HierarchicalStudy& study, const Kind& kind) {
  const auto run = load_mesh_run(study.results, std::string("element_") + kind.tangent);
  if (!run || run->steps() < 3) return std::nullopt;
  const CsvTable& h = run->history;
  return Element{kind, *run, column(h, "axial_strain", percent), column(h, "sigma22", -1e-3),
                 column(h, "volumetric_strain", percent)};
}

// Relative residuals of the last attempt at the load step that ends at this strain [%]; the first is
// the imbalance that the load increment brings.
std::vector<double> residuals(const HierarchicalStudy& study, const Element& element,
                              double strain) {
  const CsvTable table = read_csv(study.results / (element.run.name + "_newton.csv"));
  std::vector<double> found;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const auto step = static_cast<std::size_t>(table["step"][k]);
    if (step >= element.strain.size() || std::abs(element.strain[step] - strain) > 1e-6) continue;
    if (table["iteration"][k] == 0) found.clear();
    found.push_back(table["relative_residual"][k]);
  }
  return found;
}

// Largest |a / b - 1| of the stresses before the peak.
double difference(const Element& a, const std::vector<double>& strain,
                  const std::vector<double>& stress) {
  double largest = 0;
  for (std::size_t k = 0; k < a.strain.size() && a.strain[k] < before_peak; ++k) {
    const double other = interpolate(strain, stress, a.strain[k]);
    if (std::isfinite(other)) largest = std::max(largest, std::abs(a.stress[k] / other - 1));
  }
  return largest;
}

void draw_responses(HierarchicalStudy& study, const std::vector<Element>& elements) {
  Panel stress{"axial stress [kPa]", {}, 1.5};
  Panel volume{"volumetric strain, dilation + [%]"};
  if (const auto rve = load_run(study.results, "rve")) {
    const CsvTable& h = rve->history;
    study.facts.add("rve.coordination_start", h["coordination"].front());
    study.facts.add("rve.void_ratio_start", h["void_ratio"].front());
    study.facts.add("rve.volume_end", h["volumetric_strain"].back());
    study.facts.add(
        "rve.end_over_peak",
        h["sigma22"].back() / *std::min_element(h["sigma22"].begin(), h["sigma22"].end()));
    const auto strain = rve->column("axial_strain", percent);
    const auto axial = rve->column("sigma22", -1e-3);
    stress.curves.push_back({"RVE alone", strain, axial, colour::black, Stroke::dashed});
    volume.curves.push_back(
        {"", strain, rve->column("volumetric_strain", percent), colour::black, Stroke::dashed});
    for (const Element& element : elements) {
      study.facts.add(fmt::format("element.{}.apart", element.kind.tangent),
                      difference(element, strain, axial));
    }
  }
  for (const Element& element : elements) {
    stress.curves.push_back({std::string(element.kind.tangent) + " tangent", element.strain,
                             element.stress, element.kind.colour, Stroke::solid});
    volume.curves.push_back(
        {"", element.strain, element.volume, element.kind.colour, Stroke::solid});
  }
  draw({"drained compression of one element", "axial strain [%]", {stress, volume}},
       study.results / "figure_06");
}

void draw_convergence(HierarchicalStudy& study, const std::vector<Element>& elements) {
  Figure figure{"Newton's method in one element", "iteration [-]", {}};
  for (const double strain : shown) {
    Panel panel{fmt::format("residual at {} % [-]", strain), {}, 1, true};
    std::map<std::string, double> iterations;
    for (const Element& element : elements) {
      const std::vector<double> history = residuals(study, element, strain);
      if (history.size() < 2) continue;
      std::vector<double> iteration(history.size());
      std::iota(iteration.begin(), iteration.end(), 0.0);
      panel.curves.push_back({element.kind.tangent, iteration, history, element.kind.colour,
                              Stroke::solid, element.kind.marker});
      iterations[element.kind.tangent] = static_cast<double>(history.size() - 1);
    }
    if (panel.curves.empty()) continue;
    figure.panels.push_back(panel);
    for (const auto& [tangent, count] : iterations)
      study.facts.add(fmt::format("element.{}.iterations_{}", tangent, strain), count);
    if (iterations.count("elastic") > 0 && iterations.count("perturbed") > 0)
      study.facts.add(fmt::format("element.elastic_over_perturbed_{}", strain),
                      iterations["elastic"] / iterations["perturbed"]);
  }
  if (!figure.panels.empty()) draw(figure, study.results / "figure_07");
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void tabulate(const HierarchicalStudy& study, const std::vector<Element>& elements) {
  Table table(
      "One element by kind of tangent",
      {"tangent", "until[%]", "iterations_before_peak_mean[-]", "iterations_max[-]",
       "after_peak_mean[-]", "after_peak_max[-]", "cuts[-]", "loose_parts[-]", "core_time[s]"});
  for (const Element& element : elements) {
    std::array<double, 2> total{}, most{}, steps{};
    const auto& iterations = element.run.history["newton_iterations"];
    for (std::size_t k = 1; k < element.strain.size(); ++k) {
      const std::size_t part = element.strain[k] < before_peak ? 0 : 1;
      total[part] += iterations[k];
      most[part] = std::max(most[part], iterations[k]);
      ++steps[part];
    }
    table.row({element.kind.tangent, element.strain.back(), total[0] / steps[0], most[0],
               total[1] / steps[1], most[1], sum(element.run.history["step_cuts"]),
               sum(element.run.history["loose_parts"]),
               element.run.cost ? sum((*element.run.cost)["core_time"]) : std::nan("")});
  }
  table.print();
  table.write(study.results / "guo2014_multiscale_element.csv");
}

}  // namespace

void study_single_element(HierarchicalStudy& study) {
  std::vector<Element> elements;
  for (const Kind& kind : kinds)
    if (auto element = load_element(study, kind)) elements.push_back(std::move(*element));
  if (elements.empty()) return;
  draw_responses(study, elements);
  draw_convergence(study, elements);
  tabulate(study, elements);
}

}  // namespace verification

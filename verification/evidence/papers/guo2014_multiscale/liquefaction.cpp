// Figures 20 and 22: cyclic simple shear at constant volume, to liquefaction and to cyclic mobility.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double percent = 100;
constexpr double published_cycles = 13;
constexpr double yielded = 5;  // shear that ends the test under stress control [%]

// Stresses in kPa, compression positive.
struct Loop {
  std::string title;
  std::vector<double> shear;   // F12 [%]
  std::vector<double> stress;  // sigma12
  std::vector<double> normal;  // -sigma22
  std::vector<double> mean;    // p
  double void_ratio = 0;       // at the start

  [[nodiscard]] std::size_t steps() const { return shear.size(); }
};

Loop loop(const PaperRun& run, const std::string& title) {
  Loop l{title,
         run.column("F12", percent),
         run.column("sigma12", 1e-3),
         run.column("sigma22", -1e-3),
         run.column("sigma11", -1e-3),
         run.history["void_ratio"].front()};
  for (std::size_t k = 0; k < l.steps(); ++k) l.mean[k] = 0.5 * (l.mean[k] + l.normal[k]);
  return l;
}

// Turns of the shear strain, two to a cycle; the first quarter leads to the first turn.
double cycles(const std::vector<double>& path, std::size_t until) {
  int reversals = 0;
  for (std::size_t k = 1; k < until && k + 1 < path.size(); ++k)
    reversals += (path[k] - path[k - 1]) * (path[k + 1] - path[k]) < 0 ? 1 : 0;
  return 0.5 * reversals;
}

// A run that was stopped before the paper's number of cycles is not judged.
std::string verdict(bool reached, double done) {
  if (!reached && done < published_cycles) return "ended before";
  return reached && done <= published_cycles ? "agrees" : "differs";
}

void draw_loop(const Loop& l, const std::string& figure, const std::filesystem::path& results) {
  draw({l.title,
        "shear F12 [%]",
        {{"shear stress [kPa]", {{"", l.shear, l.stress, colour::blue, Stroke::thin}}, 1}}},
       results / (figure + "_loop"));
  draw({l.title,
        "vertical stress [kPa]",
        {{"shear stress [kPa]", {{"", l.normal, l.stress, colour::blue, Stroke::thin}}, 1}}},
       results / (figure + "_path"));
}

void strain_controlled(HierarchicalStudy& study, const std::string& name,
                       const std::string& title) {
  const auto run = load_run(study.results, name);
  if (!run || run->steps() < 3) return;
  const Loop l = loop(*run, title);
  draw_loop(l, name, study.results);
  double least = l.mean.front();
  std::size_t low = 0;  // the first step with less than a tenth of the start
  for (std::size_t k = 1; k < l.steps(); ++k) {
    least = std::min(least, l.mean[k]);
    if (low == 0 && l.mean[k] < 0.1 * l.mean.front()) low = k;
  }
  study.facts.add(
      "20", title + ": void ratio, cycles until p is a tenth of the start",
      "0.223; 8.6 kPa vertical stress after 12 cycles",
      low > 0 ? fmt::format("{:.4f}; {:.1f} cycles", l.void_ratio, cycles(l.shear, low))
              : fmt::format("{:.4f}; {:.0f} % of the start after {:.1f} cycles", l.void_ratio,
                            percent * least / l.mean.front(), cycles(l.shear, l.steps())),
      verdict(low > 0, cycles(l.shear, low > 0 ? low : l.steps())));
}

void stress_controlled(HierarchicalStudy& study, const std::string& name,
                       const std::string& title) {
  const auto run = load_run(study.results, name);
  if (!run || run->steps() < 3) return;
  const Loop l = loop(*run, title);
  draw_loop(l, name, study.results);
  double most = 0;
  std::size_t far = 0;  // the first step beyond 5 %
  for (std::size_t k = 1; k < l.steps(); ++k) {
    most = std::max(most, std::abs(l.shear[k]));
    if (far == 0 && std::abs(l.shear[k]) >= yielded) far = k;
  }
  study.facts.add("22", title + ": void ratio, cycles until 5 % shear strain", "0.209; 13 cycles",
                  far > 0 ? fmt::format("{:.4f}; {:.1f} cycles", l.void_ratio, cycles(l.shear, far))
                          : fmt::format("{:.4f}; {:.1f} % after {:.1f} cycles", l.void_ratio, most,
                                        cycles(l.shear, l.steps())),
                  verdict(far > 0, cycles(l.shear, far > 0 ? far : l.steps())));
}

// How far the local void ratios have gone apart when the test ends; the mean cannot change.
void void_ratios(HierarchicalStudy& study, const std::string& name, const std::string& figure,
                 const std::string& title, const std::string& paper) {
  const auto table = load_every(study.results, name, "void_ratio");
  if (!table || table->rows() < 2) return;
  double least = table->columns[1].back(), most = least;
  for (std::size_t p = 2; p < table->columns.size(); ++p) {
    least = std::min(least, table->columns[p].back());
    most = std::max(most, table->columns[p].back());
  }
  study.facts.add(
      figure, title + ": local void ratios at the end", paper,
      fmt::format("{:.4f} to {:.4f}; {:.4f} at the start", least, most, table->columns[1].front()),
      "not stated");
}

// How often packings that differ by their seed alone turn until they yield.
void tabulate_seeds(const HierarchicalStudy& study) {
  Table table("Stress control, two points, by seed of the packing",
              {"seed[-]", "void_ratio[-]", "cycles[-]", "largest_shear[%]",
               "least_mean_stress[kPa]", "ended_by"});
  int rows = 0;
  for (int seed = 1; seed <= 9; ++seed) {
    const auto run = load_run(study.results, fmt::format("cyclic_stress_seed_{}", seed));
    if (!run || run->steps() < 3) continue;
    const Loop l = loop(*run, "");
    double most = 0;
    for (const double shear : l.shear) most = std::max(most, std::abs(shear));
    table.row({static_cast<double>(seed), l.void_ratio, cycles(l.shear, l.steps()), most,
               *std::min_element(l.mean.begin(), l.mean.end()),
               most >= yielded - 0.01 ? "yes" : "no"});
    ++rows;
  }
  if (rows == 0) return;
  table.print();
  table.write(study.results / "cyclic_stress_seeds.csv");
}

}  // namespace

void study_liquefaction(HierarchicalStudy& study) {
  strain_controlled(study, "cyclic_strain_column", "strain control, two points");
  strain_controlled(study, "cyclic_strain_3x2", "strain control, 3 x 2");
  strain_controlled(study, "cyclic_strain_15x10", "strain control, 15 x 10");
  stress_controlled(study, "cyclic_stress_column", "stress control, two points");
  stress_controlled(study, "cyclic_stress_3x2", "stress control, 3 x 2");
  stress_controlled(study, "cyclic_stress_15x10", "stress control, 15 x 10");
  tabulate_seeds(study);
  void_ratios(study, "cyclic_strain_3x2", "21", "strain control, 3 x 2", "0.220 to 0.225 of 0.223");
  void_ratios(study, "cyclic_strain_15x10", "21", "strain control, 15 x 10",
              "0.220 to 0.225 of 0.223");
  void_ratios(study, "cyclic_stress_3x2", "23", "stress control, 3 x 2", "0.207 to 0.209 of 0.209");
  void_ratios(study, "cyclic_stress_15x10", "23", "stress control, 15 x 10",
              "0.207 to 0.209 of 0.209");
}

}  // namespace verification

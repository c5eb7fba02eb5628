// Figures 20 and 22: cyclic simple shear at constant volume, to liquefaction and to cyclic mobility.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double percent = 100;
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
  const auto add = [&](const char* fact, double value) {
    study.facts.add(fmt::format(fmt::runtime(fact), name), value);
  };
  const auto until = [&](const std::vector<double>& values, double below) {
    const auto found =
        std::find_if(values.begin() + 1, values.end(), [&](double value) { return value < below; });
    return found == values.end()
               ? std::nan("")
               : cycles(l.shear, static_cast<std::size_t>(found - values.begin()));
  };
  std::vector<double> peaks,
      sides;  // |shear stress| at every turn; of a negative over the one before
  for (std::size_t k = 1; k + 1 < l.steps(); ++k) {
    if ((l.shear[k] - l.shear[k - 1]) * (l.shear[k + 1] - l.shear[k]) >= 0) continue;
    peaks.push_back(std::abs(l.stress[k]));
    if (l.shear[k] < 0 && peaks.size() > 1) sides.push_back(peaks.back() / peaks[peaks.size() - 2]);
  }
  add("{}.void_ratio", l.void_ratio);
  add("{}.cycles", cycles(l.shear, l.steps()));
  add("{}.cycles_to_tenth", until(l.mean, 0.1 * l.mean.front()));
  add("{}.cycles_to_8.6kPa", until(l.normal, 8.6));
  add("{}.peaks_largest_rise", largest_rise(peaks));
  if (!sides.empty())
    add("{}.negative_over_positive_most", *std::max_element(sides.begin(), sides.end()));
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
  const auto add = [&](const char* fact, double value) {
    study.facts.add(fmt::format(fmt::runtime(fact), name), value);
  };
  add("{}.void_ratio", l.void_ratio);
  add("{}.cycles", cycles(l.shear, l.steps()));
  add("{}.cycles_to_5_percent", far > 0 ? cycles(l.shear, far) : std::nan(""));
  add("{}.shear_most", most);
  add("{}.least_mean_over_start", *std::min_element(l.mean.begin(), l.mean.end()) / l.mean.front());
}

// How far the local void ratios have gone apart when the test ends; the mean cannot change.
void void_ratios(HierarchicalStudy& study, const std::string& name) {
  const auto table = load_every(study.results, name, "void_ratio");
  if (!table || table->rows() < 2) return;
  double least = table->columns[1].back(), most = least;
  for (std::size_t p = 2; p < table->columns.size(); ++p) {
    least = std::min(least, table->columns[p].back());
    most = std::max(most, table->columns[p].back());
  }
  study.facts.add(fmt::format("{}.local_void_least", name), least);
  study.facts.add(fmt::format("{}.local_void_most", name), most);
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
  for (const char* name :
       {"cyclic_strain_3x2", "cyclic_strain_15x10", "cyclic_stress_3x2", "cyclic_stress_15x10"})
    void_ratios(study, name);
}

}  // namespace verification

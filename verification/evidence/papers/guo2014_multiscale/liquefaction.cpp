// Figures 20 and 22: cyclic simple shear at constant volume, to liquefaction and to cyclic mobility.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double percent = 100;
constexpr double yielded = 5;      // shear that ends the test under stress control [%]
constexpr double liquefied = 8.6;  // vertical stress of the paper after 12 cycles [kPa]

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

// Before the vertical stress of a test has fallen to a number; NaN where it never does.
double cycles_until(const Loop& l, const std::vector<double>& values, double below) {
  const auto found =
      std::find_if(values.begin() + 1, values.end(), [&](double value) { return value < below; });
  return found == values.end() ? std::nan("")
                               : cycles(l.shear, static_cast<std::size_t>(found - values.begin()));
}

// |shear stress| at every turn; the largest ratio of one to that before.
struct Turns {
  double largest_rise = std::nan("");
  double negative_over_positive_most = std::nan("");
};

Turns turns(const Loop& l) {
  Turns found;
  std::vector<double> peaks;
  for (std::size_t k = 1; k + 1 < l.steps(); ++k) {
    if ((l.shear[k] - l.shear[k - 1]) * (l.shear[k + 1] - l.shear[k]) >= 0) continue;
    peaks.push_back(std::abs(l.stress[k]));
    if (l.shear[k] < 0 && peaks.size() > 1)
      found.negative_over_positive_most =
          std::fmax(found.negative_over_positive_most, peaks.back() / peaks[peaks.size() - 2]);
  }
  if (peaks.size() > 1) found.largest_rise = largest_rise(peaks);
  return found;
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
  const Turns found = turns(l);
  add("{}.void_ratio", l.void_ratio);
  add("{}.cycles", cycles(l.shear, l.steps()));
  add("{}.cycles_to_tenth", cycles_until(l, l.mean, 0.1 * l.mean.front()));
  add("{}.cycles_to_8.6kPa", cycles_until(l, l.normal, liquefied));
  add("{}.peaks_largest_rise", found.largest_rise);
  add("{}.negative_over_positive_most", found.negative_over_positive_most);
}

// The largest shear, and the first step beyond 5 %; 0: none.
struct Yield {
  double most = 0;
  std::size_t at = 0;
};

Yield yield_of(const Loop& l) {
  Yield found;
  for (std::size_t k = 1; k < l.steps(); ++k) {
    found.most = std::max(found.most, std::abs(l.shear[k]));
    if (found.at == 0 && std::abs(l.shear[k]) >= yielded - 1e-6) found.at = k;
  }
  return found;
}

void stress_controlled(HierarchicalStudy& study, const std::string& name,
                       const std::string& title) {
  const auto run = load_run(study.results, name);
  if (!run || run->steps() < 3) return;
  const Loop l = loop(*run, title);
  draw_loop(l, name, study.results);
  const Yield yield = yield_of(l);
  const auto add = [&](const char* fact, double value) {
    study.facts.add(fmt::format(fmt::runtime(fact), name), value);
  };
  add("{}.void_ratio", l.void_ratio);
  add("{}.cycles", cycles(l.shear, l.steps()));
  add("{}.cycles_to_5_percent", yield.at > 0 ? cycles(l.shear, yield.at) : std::nan(""));
  add("{}.shear_most", yield.most);
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

// Packings that differ by their seed alone: all that were made, not one that was chosen.
constexpr int seeds = 9;

std::vector<std::pair<int, Loop>> loops_of_seeds(const HierarchicalStudy& study, const char* kind) {
  std::vector<std::pair<int, Loop>> found;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto run = load_run(study.results, fmt::format("cyclic_{}_seed_{}", kind, seed));
    if (run && run->steps() >= 3) found.emplace_back(seed, loop(*run, ""));
  }
  return found;
}

// Mean and standard deviation over the seeds, where all are there.
void add_means(HierarchicalStudy& study, const char* mean, const char* spread,
               const std::vector<double>& values) {
  if (values.size() != seeds) return;
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += std::pow(value - sum / seeds, 2);
  study.facts.add(mean, sum / seeds);
  study.facts.add(spread, std::sqrt(squares / (seeds - 1)));
}

// Who does not liquefy counts with all the cycles that it bore.
void strain_seeds(HierarchicalStudy& study) {
  Table table(
      "Strain control, two points, by seed of the packing",
      {"seed[-]", "void_ratio[-]", "cycles[-]", "cycles_to_a_tenth[-]", "cycles_to_8.6kPa[-]",
       "largest_rise_of_peaks[-]", "negative_over_positive_most[-]"});
  std::vector<double> voids, count, rises, sides;
  double reached = 0;
  for (const auto& [seed, l] : loops_of_seeds(study, "strain")) {
    const double all = cycles(l.shear, l.steps()), until = cycles_until(l, l.normal, liquefied);
    const Turns found = turns(l);
    table.row({static_cast<double>(seed), l.void_ratio, all,
               cycles_until(l, l.mean, 0.1 * l.mean.front()), until, found.largest_rise,
               found.negative_over_positive_most});
    reached += std::isfinite(until) ? 1 : 0;
    voids.push_back(l.void_ratio), count.push_back(std::isfinite(until) ? until : all);
    rises.push_back(found.largest_rise), sides.push_back(found.negative_over_positive_most);
  }
  if (voids.empty()) return;
  table.print();
  table.write(study.results / "cyclic_strain_seeds.csv");
  add_means(study, "cyclic_strain_seeds.void_ratio_mean", "cyclic_strain_seeds.void_ratio_spread",
            voids);
  add_means(study, "cyclic_strain_seeds.cycles_to_8.6kPa_mean",
            "cyclic_strain_seeds.cycles_to_8.6kPa_spread", count);
  add_means(study, "cyclic_strain_seeds.peaks_largest_rise_mean",
            "cyclic_strain_seeds.peaks_largest_rise_spread", rises);
  add_means(study, "cyclic_strain_seeds.negative_over_positive_mean",
            "cyclic_strain_seeds.negative_over_positive_spread", sides);
  study.facts.add("cyclic_strain_seeds.reached_8.6kPa", reached);
}

// Fall of the normal stress from the start of a half cycle to its end, summed over those of a sign.
double falls(const Loop& l, double sign) {
  double sum = 0;
  std::size_t start = 0;
  for (std::size_t k = 1; k <= l.steps(); ++k) {
    if (k < l.steps() && l.stress[k] * l.stress[k - 1] > 0) continue;
    if (l.stress[k - 1] * sign > 0) sum += l.normal[start] - l.normal[k - 1];
    start = k;
  }
  return sum;
}

void stress_seeds(HierarchicalStudy& study) {
  Table table("Stress control, two points, by seed of the packing",
              {"seed[-]", "void_ratio[-]", "cycles[-]", "largest_shear[%]", "ended_by",
               "least_mean_stress[kPa]", "fall_positive[kPa]", "fall_negative[kPa]"});
  std::vector<double> voids, count, least;
  double positive = 0, negative = 0, reached = 0;
  for (const auto& [seed, l] : loops_of_seeds(study, "stress")) {
    const Yield yield = yield_of(l);
    const double lowest = *std::min_element(l.mean.begin(), l.mean.end());
    const double all = cycles(l.shear, yield.at > 0 ? yield.at : l.steps());
    table.row({static_cast<double>(seed), l.void_ratio, all, yield.most,
               yield.at > 0 ? "yes" : "no", lowest, falls(l, 1), falls(l, -1)});
    positive += falls(l, 1), negative += falls(l, -1), reached += yield.at > 0 ? 1 : 0;
    voids.push_back(l.void_ratio), count.push_back(all), least.push_back(lowest / l.mean.front());
  }
  if (voids.empty()) return;
  table.print();
  table.write(study.results / "cyclic_stress_seeds.csv");
  add_means(study, "cyclic_stress_seeds.void_ratio_mean", "cyclic_stress_seeds.void_ratio_spread",
            voids);
  add_means(study, "cyclic_stress_seeds.cycles_to_5_percent_mean",
            "cyclic_stress_seeds.cycles_to_5_percent_spread", count);
  if (voids.size() != seeds) return;
  study.facts.add("cyclic_stress_seeds.reached_5_percent", reached);
  study.facts.add("cyclic_stress_seeds.least_mean_over_start",
                  *std::min_element(least.begin(), least.end()));
  study.facts.add("cyclic_stress_seeds.fall_negative_over_positive", negative / positive);
}

void study_seeds(HierarchicalStudy& study) {
  strain_seeds(study);
  stress_seeds(study);
}

}  // namespace

void study_liquefaction(HierarchicalStudy& study) {
  strain_controlled(study, "cyclic_strain_column", "strain control, two points");
  strain_controlled(study, "cyclic_strain_3x2", "strain control, 3 x 2");
  strain_controlled(study, "cyclic_strain_15x10", "strain control, 15 x 10");
  stress_controlled(study, "cyclic_stress_column", "stress control, two points");
  stress_controlled(study, "cyclic_stress_3x2", "stress control, 3 x 2");
  stress_controlled(study, "cyclic_stress_15x10", "stress control, 15 x 10");
  study_seeds(study);
  for (const char* name :
       {"cyclic_strain_3x2", "cyclic_strain_15x10", "cyclic_stress_3x2", "cyclic_stress_15x10"})
    void_ratios(study, name);
}

}  // namespace verification

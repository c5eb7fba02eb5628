// Figures 2, 4 and 5: regular packings under biaxial compression and true shear.

#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

struct Condition {
  const char* name;
  const char* colour;
  Stroke stroke;
};
constexpr std::array<Condition, 3> conditions{{{"D", colour::blue, Stroke::solid},
                                               {"P", colour::orange, Stroke::solid},
                                               {"T", colour::green, Stroke::solid}}};
constexpr std::array<int, 3> sizes{25, 100, 225};

std::vector<double> shear(const PaperRun& run) { return run.column("F12", -1); }

// Largest |a - b| / largest |b| of sigma11 over the common steps where -F12 lies in the range; NaN
// without one.
double largest_difference(const PaperRun& a, const PaperRun& b, double from, double to) {
  double difference = std::nan(""), size = 0;
  const std::vector<double>&x = a.history["F12"], &u = a.history["sigma11"],
        &v = b.history["sigma11"];
  for (std::size_t k = 0; k < std::min(a.steps(), b.steps()); ++k) {
    size = std::max(size, std::abs(v[k]));
    if (-x[k] < from - 1e-9 || -x[k] > to + 1e-9) continue;
    difference = std::fmax(difference, std::abs(u[k] - v[k]));
  }
  return difference / size;
}

// The deepest minimum of -sigma11 in 0.05 < -F12 < 0.2: where, and how far it lies below what comes
// before and after it in there, over the largest value of the run. A steady fall has none.
struct Minimum {
  double at = std::nan(""), depth = 0;
};

Minimum deepest_minimum(const PaperRun& run) {
  std::vector<double> at, stress;
  double largest = 0;
  for (std::size_t k = 0; k < run.steps(); ++k) {
    const double x = -run.history["F12"][k], s = -run.history["sigma11"][k];
    largest = std::max(largest, s);
    if (x > 0.05 && x < 0.2) at.push_back(x), stress.push_back(s);
  }
  Minimum minimum;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const auto here = stress.begin() + static_cast<std::ptrdiff_t>(k);
    const double before = *std::max_element(stress.begin(), here + 1);
    const double after = *std::max_element(here, stress.end());
    const double depth = (std::min(before, after) - stress[k]) / largest;
    if (depth > minimum.depth) minimum = {at[k], depth};
  }
  return minimum;
}

void figure_2(PaperStudy& study, const PaperUnits& units) {
  Figure figure{"Fig. 2: 25 discs, with and without prediction of the boundary", "-F12 [-]", {}};
  std::vector<double> middle;
  for (const char* condition : {"P", "T"}) {
    const std::string prefix = std::string("figure_02_") + condition;
    const auto predicted = study.run(prefix + "_predicted");
    const auto plain = study.run(prefix + "_plain");
    const auto direct = study.run(prefix + "_direct");
    if (!predicted || !plain) continue;
    Panel panel{fmt::format("({})  -σ R / kn [-]", condition), {}, 1.4};
    // The second panel adds nothing to the legend.
    const auto title = [&](const char* text) {
      return std::string(figure.panels.empty() ? text : "");
    };
    for (const char* component : {"sigma11", "sigma12"}) {
      const bool normal = std::string(component) == "sigma11";
      const auto stress = [&](const PaperRun& run) {
        return run.column(component, -units.stress());
      };
      const char* dark = normal ? colour::blue : colour::orange;
      panel.curves.push_back({title(normal ? "σ11, servo with prediction" : "σ12, the same"),
                              shear(*predicted), stress(*predicted), dark, Stroke::solid});
      panel.curves.push_back({normal ? title("servo without prediction") : "", shear(*plain),
                              stress(*plain), dark, Stroke::dashed});
      if (direct)
        panel.curves.push_back({normal ? title("direct") : "", shear(*direct), stress(*direct),
                                normal ? colour::sky : colour::amber, Stroke::thin});
    }
    figure.panels.push_back(panel);
    const auto add = [&](const char* name, double value) {
      study.facts.add(fmt::format(fmt::runtime(name), condition), value);
    };
    const Minimum minimum = deepest_minimum(*predicted);
    add("figure_02.{}.steps", predicted->history["step"].back());
    add("figure_02.{}.predicted_minimum_at", minimum.at);
    add("figure_02.{}.predicted_minimum", minimum.depth);
    add("figure_02.{}.plain_minimum", deepest_minimum(*plain).depth);
    add("figure_02.{}.apart_early", largest_difference(*predicted, *plain, 0.0, 0.05));
    middle.push_back(largest_difference(*predicted, *plain, 0.05, 0.2));
    add("figure_02.{}.apart_middle", middle.back());
    add("figure_02.{}.apart_end", largest_difference(*predicted, *plain, 0.28, 0.3));
    add("figure_02.{}.reached_predicted", shear(*predicted).back());
    add("figure_02.{}.reached_plain", shear(*plain).back());
    if (direct) add("figure_02.{}.reached_direct", shear(*direct).back());
  }
  if (middle.size() == 2)
    study.facts.add("figure_02.T.apart_middle_over_P", middle.back() / middle.front());
  if (!figure.panels.empty()) draw(figure, study.results / "figure_02");
}

// Relaxation steps of the servo under P with its best prediction over those without.
void steps_of_the_servo(PaperStudy& study) {
  const CaseEnds ends(study.results / "figure_02_cases.csv");
  const auto plain = ends.find("figure_02_P_plain");
  if (!plain) return;
  double least = std::nan("");
  for (const char* share : {"quarter", "half", "three_quarters", "predicted"}) {
    const auto k = ends.find(std::string("figure_02_P_") + share);
    if (!k || ends.table["steps"][*k] < ends.table["steps_wanted"][*k]) continue;
    const double steps = ends.table["relaxation_steps"][*k];
    study.facts.add(fmt::format("figure_02.P.relaxation_steps_{}", share), steps);
    least = std::fmin(least, steps / ends.table["relaxation_steps"][*plain]);
  }
  study.facts.add("figure_02.P.steps_predicted_over_plain", least);
}

void figure_4(PaperStudy& study, const PaperUnits& units) {
  Figure figure{"Fig. 4: 25 discs under D, P and T", "-F12 [-]", {}};
  Panel stress{"-σ11 R / kn [-]"};
  Panel overlap{"mean overlap / R [%]"};
  for (const Condition& c : conditions) {
    const auto run = study.run(fmt::format("figure_05_{}25", c.name));
    if (!run) continue;
    stress.curves.push_back(
        {c.name, shear(*run), run->column("sigma11", -units.stress()), c.colour, c.stroke});
    if (!run->particles) continue;
    std::vector<double> percent = (*run->particles)["normalised_overlap"];
    for (double& value : percent) value *= 100;
    std::vector<double> x = (*run->particles)["F12"];
    for (double& value : x) value = -value;
    overlap.curves.push_back({c.name, x, percent, c.colour, c.stroke});
  }
  if (stress.curves.empty()) return;
  figure.panels = {stress, overlap};
  draw(figure, study.results / "figure_04");
}

void figure_5(PaperStudy& study, const PaperUnits& units) {
  Figure figure{"Fig. 5: -σ11 R / kn of 25, 100 and 225 discs", "-F12 [-]", {}};
  constexpr std::array<const char*, 3> shades{colour::blue, colour::orange, colour::green};
  for (const Condition& c : conditions) {
    Panel panel{fmt::format("({})  -σ11 R / kn [-]", c.name)};
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const auto run = study.run(fmt::format("figure_05_{}{}", c.name, sizes[k]));
      if (run)
        panel.curves.push_back({figure.panels.empty() ? fmt::format("{} discs", sizes[k]) : "",
                                shear(*run), run->column("sigma11", -units.stress()), shades[k],
                                Stroke::solid});
    }
    if (!panel.curves.empty()) figure.panels.push_back(panel);
  }
  if (!figure.panels.empty()) draw(figure, study.results / "figure_05");
}

// Mean -sigma11 R / kn over the first steps.
double mean_stress(const PaperRun& run, const PaperUnits& units, std::size_t steps) {
  double sum = 0;
  for (std::size_t k = 0; k < steps; ++k) sum -= run.history["sigma11"][k] * units.stress();
  return sum / static_cast<double>(steps);
}

// Root mean square of the difference over that of b, common steps.
double apart(const PaperRun& a, const PaperRun& b) {
  double difference = 0, size = 0;
  for (std::size_t k = 0; k < std::min(a.steps(), b.steps()); ++k) {
    const double u = a.history["sigma11"][k], v = b.history["sigma11"][k];
    difference += (u - v) * (u - v);
    size += v * v;
  }
  return std::sqrt(difference / size);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t count = std::min(a.size(), b.size());
  double mean_a = 0, mean_b = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < count; ++k) mean_a += a[k], mean_b += b[k];
  mean_a /= static_cast<double>(count), mean_b /= static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double u = a[k] - mean_a, v = b[k] - mean_b;
    ab += u * v, aa += u * u, bb += v * v;
  }
  return ab / std::sqrt(aa * bb);
}

std::size_t common_steps(const std::vector<PaperRun>& runs) {
  std::size_t common = runs.front().steps();
  for (const PaperRun& run : runs) common = std::min(common, run.steps());
  return common;
}

std::vector<PaperRun> runs_of_sizes(const PaperStudy& study, const char* condition) {
  std::vector<PaperRun> runs;
  for (const int size : sizes)
    if (auto run = study.run(fmt::format("figure_05_{}{}", condition, size)))
      runs.push_back(*std::move(run));
  return runs;
}

void sample_size(PaperStudy& study, const PaperUnits& units) {
  std::vector<std::vector<PaperRun>> all;
  for (const Condition& c : conditions) {
    all.push_back(runs_of_sizes(study, c.name));
    const std::vector<PaperRun>& runs = all.back();
    if (runs.size() != sizes.size()) return;
    const std::size_t common = common_steps(runs);
    std::vector<double> mean;
    double least = 1;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      mean.push_back(mean_stress(runs[k], units, common));
      const double reached = shear(runs[k]).back();
      least = std::min(least, reached);
      study.facts.add(fmt::format("figure_05.{}{}.mean", c.name, sizes[k]), mean.back());
      study.facts.add(fmt::format("figure_05.{}{}.reached", c.name, sizes[k]), reached);
      study.facts.add(fmt::format("figure_05.{}{}.end_over_start", c.name, sizes[k]),
                      runs[k].history["sigma11"].back() / runs[k].history["sigma11"].front());
      if (runs[k].particles)
        study.facts.add(
            fmt::format("figure_05.{}{}.overlap_stress_correlation", c.name, sizes[k]),
            correlation((*runs[k].particles)["normalised_overlap"], runs[k].column("sigma11", -1)));
    }
    study.facts.add(fmt::format("figure_05.{}.largest_rise", c.name), largest_rise(mean));
    study.facts.add(fmt::format("figure_05.{}.reached_least", c.name), least);
    study.facts.add(fmt::format("figure_05.{}.rms_100_225", c.name), apart(runs[1], runs[2]));
  }
  const PaperRun &d = all[0][0], &t = all[2][0];
  study.facts.add("figure_05.start_T_over_D",
                  t.history["sigma11"].front() / d.history["sigma11"].front());
  if (d.particles)
    study.facts.add("figure_05.overlap_start", 100 * (*d.particles)["normalised_overlap"].front());
  std::vector<double> spreads;  // of D, P and T, by size
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const std::vector<PaperRun> runs{all[0][k], all[1][k], all[2][k]};
    std::vector<double> mean;
    for (const PaperRun& run : runs) mean.push_back(mean_stress(run, units, common_steps(runs)));
    spreads.push_back(spread(mean) - 1);
  }
  study.facts.add("figure_05.spread_225_over_25", spreads.back() / spreads.front());
}

}  // namespace

void study_regular_packings(PaperStudy& study) {
  const PaperUnits units = read_units(study.scenes / "pack_square_25.toml");
  figure_2(study, units);
  steps_of_the_servo(study);
  figure_4(study, units);
  figure_5(study, units);
  sample_size(study, units);
}

}  // namespace verification

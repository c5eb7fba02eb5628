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

// Largest |a - b| / largest |b| of a stress component over the steps where -F12 lies in the range.
double largest_difference(const PaperRun& a, const PaperRun& b, const char* component, double from,
                          double to) {
  double difference = 0, size = 0;
  const std::vector<double>&x = a.history["F12"], &u = a.history[component],
        &v = b.history[component];
  for (std::size_t k = 0; k < std::min(a.steps(), b.steps()); ++k) {
    size = std::max(size, std::abs(v[k]));
    if (-x[k] < from - 1e-9 || -x[k] > to + 1e-9) continue;
    difference = std::max(difference, std::abs(u[k] - v[k]));
  }
  return size > 0 ? difference / size : 0;
}

void figure_2(PaperStudy& study, const PaperUnits& units) {
  Figure figure{"Fig. 2: 25 discs, with and without prediction of the boundary", "-F12 [-]", {}};
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
    const double before = largest_difference(*predicted, *plain, "sigma11", 0.0, 0.05);
    const double middle = largest_difference(*predicted, *plain, "sigma11", 0.05, 0.2);
    const double end = largest_difference(*predicted, *plain, "sigma11", 0.28, 0.3);
    study.facts.agree(
        "2",
        fmt::format("{}: with and without prediction part and meet again at the end", condition),
        "branches near -F12 = 0.113, coalesced near 0.28",
        fmt::format("apart by {:.1f} % of the largest stress up to 0.05, {:.1f} % in 0.05-0.2, "
                    "{:.1f} % in 0.28-0.3",
                    100 * before, 100 * middle, 100 * end),
        middle > end);
    study.facts.add("2", fmt::format("{}: -F12 reached", condition), "0.3",
                    fmt::format("servo with prediction {:.3f}; without {:.3f}; direct {:.3f}",
                                shear(*predicted).back(), shear(*plain).back(),
                                direct ? shear(*direct).back() : 0.0),
                    shear(*predicted).back() > 0.2999 ? "agrees" : "differs");
  }
  if (!figure.panels.empty()) draw(figure, study.results / "figure_02");
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

void sample_size(PaperStudy& study, const PaperUnits& units) {
  for (const Condition& c : conditions) {
    std::vector<PaperRun> runs;
    for (const int size : sizes)
      if (auto run = study.run(fmt::format("figure_05_{}{}", c.name, size)))
        runs.push_back(*std::move(run));
    if (runs.size() != sizes.size()) return;
    std::size_t common = runs.front().steps();
    for (const PaperRun& run : runs) common = std::min(common, run.steps());
    std::array<double, 3> mean{};
    for (std::size_t k = 0; k < sizes.size(); ++k) mean[k] = mean_stress(runs[k], units, common);
    study.facts.agree(
        "5", fmt::format("{}: larger samples carry less", c.name),
        "falls with size; D and P close for 100 and 225",
        fmt::format("mean -σ11 R / kn to -F12 = {:.3f}: {:.4f}, {:.4f}, {:.4f} for 25, 100, 225",
                    shear(runs.front())[common - 1], mean[0], mean[1], mean[2]),
        mean[0] >= mean[1] && mean[1] >= mean[2]);
  }
}

}  // namespace

void study_regular_packings(PaperStudy& study) {
  const PaperUnits units = read_units(study.scenes / "pack_square_25.toml");
  figure_2(study, units);
  figure_4(study, units);
  figure_5(study, units);
  sample_size(study, units);
}

}  // namespace verification

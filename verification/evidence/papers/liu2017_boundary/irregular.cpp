// Figures 7, 9 and 10: irregular packings in simple shear.

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
  int marker;
};
constexpr std::array<Condition, 3> conditions{
    {{"D", colour::blue, 5}, {"P", colour::orange, 7}, {"T", colour::green, 9}}};
// A fourth row of figure 10: P with every contact on a side counted on both sides, as published.
constexpr Condition published_weight{"P_one", colour::sky, 6};
// Particle numbers of the paper; ours are close to them and told in the tables.
constexpr std::array<int, 5> sizes{37, 120, 228, 444, 650};
constexpr double paper_norm = 0.011;

void figure_7(const PaperStudy& study, const PaperUnits& units) {
  Figure figure{"Fig. 7: simple shear of the packing near 228 discs", "F12 [-]", {}};
  for (const auto& [component, name] : {std::pair{"sigma11", "-σ11 R / kn [-]"},
                                        {"sigma22", "-σ22 R / kn [-]"},
                                        {"sigma12", "σ12 R / kn [-]"}}) {
    Panel panel{name};
    const double sign = std::string(component) == "sigma12" ? 1 : -1;
    for (const Condition& c : conditions)
      if (const auto run = study.run(std::string("figure_08_") + c.name))
        panel.curves.push_back({c.name, run->column("F12"),
                                run->column(component, sign * units.stress()), c.colour,
                                Stroke::solid});
    if (!panel.curves.empty()) figure.panels.push_back(panel);
  }
  if (!figure.panels.empty()) draw(figure, study.results / "figure_07");
}

void figure_9(const PaperStudy& study) {
  Panel overlap{"mean overlap / R [%]"};
  Panel rotation{"mean |rotation| [rad]"};
  for (const Condition& c : conditions) {
    const auto run = study.run(std::string("figure_08_") + c.name);
    if (!run || !run->particles) continue;
    const CsvTable& particles = *run->particles;
    std::vector<double> percent = particles["normalised_overlap"];
    for (double& value : percent) value *= 100;
    overlap.curves.push_back({c.name, particles["F12"], percent, c.colour, Stroke::solid});
    rotation.curves.push_back(
        {c.name, particles["F12"], particles["mean_rotation_magnitude"], c.colour, Stroke::solid});
  }
  if (!overlap.curves.empty())
    draw({"Fig. 9: simple shear of the packing near 228 discs", "F12 [-]", {overlap, rotation}},
         study.results / "figure_09");
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

void facts_of_228(PaperStudy& study) {
  const auto d = study.run("figure_08_D");
  const auto p = study.run("figure_08_P");
  const auto t = study.run("figure_08_T");
  if (!p) return;
  const double normal = 0.5 * (mean(p->column("sigma11", -1)) + mean(p->column("sigma22", -1)));
  const double shear = mean(p->column("sigma12"));
  study.facts.agree("7", "P: shear stress / normal stress, mean over the path", "about one third",
                    fmt::format("{:.2f}", shear / normal),
                    shear / normal > 0.25 && shear / normal < 0.42);
  const double ratio = mean(p->column("sigma11")) / mean(p->column("sigma22"));
  study.facts.agree("7", "P: the two normal stresses are similar", "similar",
                    fmt::format("mean σ11 / mean σ22 = {:.2f}", ratio),
                    ratio > 0.8 && ratio < 1.25);
  std::string escaped;
  for (const double shear : {0.2, 0.3, 0.4, 0.5})
    escaped +=
        fmt::format("{}{:.0f} at {}", escaped.empty() ? "" : "; ",
                    interpolate(p->history["F12"], p->history["escaped_particles"], shear), shear);
  study.facts.add("8", "P: inner particles outside the frame", "not stated", escaped, "-");
  if (!d || !t || !d->particles || !p->particles || !t->particles) return;
  const std::size_t common = std::min({d->steps(), p->steps(), t->steps()});
  const auto at = [&](const PaperRun& run, const char* what) {
    std::vector<double> values = (*run.particles)[what];
    values.resize(std::min(values.size(), common));
    return mean(values);
  };
  const auto row = [&](const char* quantity, const char* paper, const char* what, double unit,
                       bool falling) {
    const double a = at(*d, what) * unit, b = at(*p, what) * unit, c = at(*t, what) * unit;
    study.facts.agree("9", quantity, paper,
                      fmt::format("means up to F12 = {:.3f}: D {:.3g}, P {:.3g}, T {:.3g}",
                                  t->history["F12"][common - 1], a, b, c),
                      falling ? a >= b && b >= c : a <= b && b <= c);
  };
  row("mean overlap / R [%]", "largest for D, smallest for T", "normalised_overlap", 100, true);
  row("mean rotation magnitude [rad]", "largest for T, smallest for D", "mean_rotation_magnitude",
      1, false);
}

// The file with the paths of this machine has the whole text.
std::string how(const CaseEnds& ends, std::size_t k) {
  if (ends.table["steps"][k] == 0) return "no equilibrium at F = I";
  return grainlaw_status_text(
      static_cast<grainlaw_status>(static_cast<int>(ends.table["status"][k])));
}

void reach_of_t(PaperStudy& study, const CaseEnds& ends) {
  Table table(
      "How far T carries in simple shear to 0.5",
      {"initial_pressure[kPa]", "packing[-]", "particles[-]", "F12_reached[-]", "steps[-]", "end"});
  for (const auto& [suffix, pressure] : {std::pair{"", "10"}, {"_100kPa", "100"}}) {
    std::string reached;
    bool all = true;
    for (const int size : sizes) {
      const auto k = ends.find(fmt::format("figure_10_T{}{}", size, suffix));
      if (!k) continue;
      const double shear = ends.table["F12"][*k];
      table.row({pressure, fmt::format("{}", size), ends.table["particles"][*k], shear,
                 ends.table["steps"][*k], how(ends, *k)});
      reached += fmt::format("{}{:.3f}", reached.empty() ? "" : "; ", shear);
      all = all && shear > 0.4999;
    }
    if (reached.empty()) continue;
    study.facts.agree("10",
                      fmt::format("T from {} kPa: F12 reached by the five packings", pressure),
                      "0.5", reached, all);
  }
  table.print();
  table.write(study.results / "reach_of_t.csv");
}

void figure_10(PaperStudy& study, const PaperUnits& units, const CaseEnds& ends) {
  Table table("Stress norm of eq. 42", {"condition", "packing[-]", "particles[-]", "stress_norm[-]",
                                        "until_F12[-]", "stress_norm_start[-]"});
  Panel panel{"|σ R / kn|, L2 over the path [-]", {}, 1.5};
  std::array<std::vector<double>, 4> norms;
  std::vector<double> starts;
  for (std::size_t c = 0; c < norms.size(); ++c) {
    const bool weighted = c < conditions.size();
    const Condition& condition = weighted ? conditions[c] : published_weight;
    std::vector<double> count;
    for (const int size : sizes) {
      const std::string name = weighted ? fmt::format("figure_10_{}{}", condition.name, size)
                                        : fmt::format("figure_10_P{}_one", size);
      const auto run = study.run(name);
      const auto k = ends.find(name);
      if (!run || !k) continue;
      count.push_back(ends.table["particles"][*k]);
      norms[c].push_back(integrated_norm(*run, units));
      const double start = stress_norm(*run, units).front();
      if (c == 1) starts.push_back(run->history["sigma11"].front());
      table.row({weighted ? condition.name : "P; weight 1", fmt::format("{}", size), count.back(),
                 norms[c].back(), run->history["F12"].back(), start});
    }
    if (!count.empty())
      panel.curves.push_back({weighted ? condition.name : "P, contact weight 1", count, norms[c],
                              condition.colour, weighted ? Stroke::solid : Stroke::dashed,
                              condition.marker});
  }
  if (panel.curves.empty()) return;
  panel.curves.push_back({"0.011 of the paper for P",
                          {sizes.front() * 1.0, sizes.back() * 1.0},
                          {paper_norm, paper_norm},
                          colour::grey,
                          Stroke::dashed});
  draw({"Fig. 10: simple shear to F12 = 0.5", "particles of the frame [-]", {panel}},
       study.results / "figure_10");
  table.print();
  table.write(study.results / "stress_norm.csv");

  const auto list = [](const std::vector<double>& values) {
    std::string text;
    for (const double value : values)
      text += fmt::format("{}{:.4f}", text.empty() ? "" : ", ", value);
    return text;
  };
  const auto& [d, p, t, one] = norms;
  if (d.size() == sizes.size())
    study.facts.agree("10", "D: norm falls with size", "falls", list(d), d.front() > d.back());
  if (p.size() == sizes.size()) {
    const auto [low, high] = std::minmax_element(p.begin(), p.end());
    study.facts.add(
        "10", "P: norm of one packing per size", "near 0.011",
        fmt::format(
            "{}; mean {:.4f}, largest / smallest {:.2f}, from {:.1f} kPa, p t / kn = {:.1g}",
            list(p), mean(p), *high / *low, -1e-3 * mean(starts),
            -mean(starts) * units.thickness / units.stiffness),
        "see the ensemble");
  }
  if (one.size() == sizes.size())
    study.facts.add("10", "P, contact weight 1 as published: norm", "near 0.011",
                    fmt::format("{}; mean {:.4f}", list(one), mean(one)),
                    std::abs(mean(one) / paper_norm - 1) < 0.1 ? "agrees" : "differs");
  if (t.size() == sizes.size())
    study.facts.agree("10", "T: norm rises with size", "rises",
                      list(t) + " (each up to where T carries)", t.front() < t.back());
}

}  // namespace

void study_irregular_packings(PaperStudy& study) {
  const PaperUnits units = read_units(study.scenes / "pack_228.toml");
  const CaseEnds ends(study.results / "figure_10_cases.csv");
  figure_7(study, units);
  figure_9(study);
  facts_of_228(study);
  figure_10(study, units, ends);
  reach_of_t(study, ends);
}

}  // namespace verification

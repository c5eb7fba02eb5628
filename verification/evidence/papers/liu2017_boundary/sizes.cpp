// Figure 10 as an ensemble: what of the stress norm belongs to the size of a packing, and what to the packing.

#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr std::array<int, 5> sizes{37, 120, 228, 444, 650};
constexpr double paper_norm = 0.011;
constexpr double early = 0.1;  // F12 before which no packing softens [-]

struct Sample {
  std::vector<double> value;

  [[nodiscard]] double mean() const {
    double sum = 0;
    for (const double v : value) sum += v;
    return sum / static_cast<double>(value.size());
  }
  [[nodiscard]] double deviation() const {
    double squares = 0;
    for (const double v : value) squares += (v - mean()) * (v - mean());
    return std::sqrt(squares / static_cast<double>(value.size() - 1));
  }
  [[nodiscard]] double error() const {
    return deviation() / std::sqrt(static_cast<double>(value.size()));
  }
};

// How the cases of sizes.toml and of sizes_rough.toml ended.
struct Ends {
  CaseEnds plain, rough;
  [[nodiscard]] const CaseEnds& of(const std::string& name) const {
    return name.starts_with("rough") ? rough : plain;
  }
};

double fluctuation_of_pressure(const PaperRun& run) {
  Sample pressure;
  for (std::size_t k = 0; k < run.steps(); ++k)
    if (run.history["F12"][k] > early)
      pressure.value.push_back(-0.5 * (run.history["sigma11"][k] + run.history["sigma22"][k]));
  return pressure.deviation() / pressure.mean();
}

// The seeds of one case.
struct Ensemble {
  int seeds = 0;
  Sample particles, fraction;
  Sample norm, early_norm;  // of those that were led to the end [-]
  Sample fluctuation;       // s.d. / mean of the pressure along the later path [-]
  Sample reached;           // F12, 0 without an equilibrium at F = I [-]
  int carried = 0;          // with an equilibrium at F = I
};

Ensemble read_ensemble(const PaperStudy& study, const Ends& all, const PaperUnits& units,
                       const std::string& name) {
  const CaseEnds& ends = all.of(name);
  Ensemble ensemble;
  while (const auto k = ends.find(fmt::format("sizes_{}_s{}", name, ensemble.seeds + 1))) {
    ++ensemble.seeds;
    ensemble.reached.value.push_back(ends.table["F12"][*k]);
    const auto run = study.run(ends.name[*k]);
    if (!run || ends.table["particles"][*k] == 0) continue;
    ++ensemble.carried;
    ensemble.particles.value.push_back(ends.table["particles"][*k]);
    ensemble.fraction.value.push_back(1 / (1 + run->history["void_ratio"].front()));
    if (ends.table["steps"][*k] < ends.table["steps_wanted"][*k]) continue;
    ensemble.norm.value.push_back(integrated_norm(*run, units));
    ensemble.early_norm.value.push_back(integrated_norm(*run, units, early));
    ensemble.fluctuation.value.push_back(fluctuation_of_pressure(*run));
  }
  return ensemble;
}

struct Row {
  const char* name;  // of the cases, before the size
  const char* text;
  const char* colour;
  int marker;
};
constexpr std::array<Row, 4> rows{{{"D", "D", colour::blue, 5},
                                   {"P", "P", colour::orange, 7},
                                   {"cell", "periodic cell", colour::purple, 9},
                                   {"rough_P", "P; made with friction", colour::sky, 11}}};

using Means = std::array<std::vector<Ensemble>, rows.size()>;

Means stress_norms(const PaperStudy& study, const Ends& ends, const PaperUnits& units) {
  Table table("Stress norm of eq. 42, ensembles",
              {"condition", "packing[-]", "seeds[-]", "led_to_the_end[-]", "particles_mean[-]",
               "volume_fraction_mean[-]", "volume_fraction_sd[-]", "stress_norm_mean[-]",
               "stress_norm_sd[-]", "standard_error[-]", "norm_to_0.1_mean[-]",
               "norm_to_0.1_standard_error[-]", "later_pressure_sd_over_mean[-]"});
  Panel panel{"|σ R / kn|, mean ± s.d. [-]", {}, 1.5};
  Means means;
  for (std::size_t c = 0; c < rows.size(); ++c) {
    Curve curve{rows[c].text, {}, {}, rows[c].colour, Stroke::solid, rows[c].marker};
    Curve low{"", {}, {}, rows[c].colour, Stroke::dashed}, high = low;
    for (const int size : sizes) {
      Ensemble e = read_ensemble(study, ends, units, fmt::format("{}{}", rows[c].name, size));
      if (e.norm.value.size() < 2) continue;
      table.row({rows[c].text, fmt::format("{}", size), static_cast<double>(e.seeds),
                 static_cast<double>(e.norm.value.size()), e.particles.mean(), e.fraction.mean(),
                 e.fraction.deviation(), e.norm.mean(), e.norm.deviation(), e.norm.error(),
                 e.early_norm.mean(), e.early_norm.error(), e.fluctuation.mean()});
      for (Curve* one : {&curve, &low, &high}) one->x.push_back(static_cast<double>(size));
      curve.y.push_back(e.norm.mean());
      low.y.push_back(e.norm.mean() - e.norm.deviation());
      high.y.push_back(e.norm.mean() + e.norm.deviation());
      means[c].push_back(std::move(e));
    }
    if (curve.x.empty()) continue;
    panel.curves.push_back(curve);
    if (c < 2) panel.curves.insert(panel.curves.end(), {low, high});
  }
  if (panel.curves.empty()) return means;
  panel.curves.push_back({"0.011 of the paper for P",
                          {sizes.front() * 1.0, sizes.back() * 1.0},
                          {paper_norm, paper_norm},
                          colour::grey,
                          Stroke::dashed});
  draw({"Fig. 10 as an ensemble: simple shear to F12 = 0.5", "particles of the frame [-]", {panel}},
       study.results / "figure_10_ensemble");
  table.print();
  table.write(study.results / "sizes.csv");
  return means;
}

std::vector<double> means_of(const std::vector<Ensemble>& ensembles, const Sample Ensemble::*what) {
  std::vector<double> values;
  for (const Ensemble& e : ensembles) values.push_back((e.*what).mean());
  return values;
}

void add_facts(PaperStudy& study, const Means& means) {
  const auto& [d, p, cell, rough] = means;
  if (d.size() != sizes.size() || p.size() != sizes.size()) return;
  const std::vector<double> of_d = means_of(d, &Ensemble::norm),
                            of_p = means_of(p, &Ensemble::norm);
  study.facts.add("sizes.D.largest_rise", largest_rise(of_d));
  study.facts.add("sizes.P.spread", spread(of_p));
  study.facts.add("sizes.P.spread_from_120", spread({of_p.begin() + 1, of_p.end()}));
  study.facts.add("sizes.D.spread_from_120", spread({of_d.begin() + 1, of_d.end()}));
  study.facts.add("sizes.P.spread_early", spread(means_of(p, &Ensemble::early_norm)));
  study.facts.add("sizes.P.norm_650", of_p.back());
  study.facts.add("sizes.P.norm_650_standard_error", p.back().norm.error());
  study.facts.add(
      "sizes.D_less_P_650",
      (of_d.back() - of_p.back()) / std::hypot(d.back().norm.error(), p.back().norm.error()));
}

void initial_pressures(const PaperStudy& study, const Ends& ends, const PaperUnits& units) {
  Table table(
      "Stress norm of P near 228 discs by initial pressure",
      {"initial_pressure[kPa]", "p_t_over_kn[-]", "seeds[-]", "led_to_the_end[-]",
       "volume_fraction_mean[-]", "stress_norm_mean[-]", "stress_norm_sd[-]", "standard_error[-]"});
  int count = 0;
  for (const auto& [name, pressure] : {std::pair{"P228_1kPa", 1.0},
                                       {"P228_3kPa", 3.0},
                                       {"P228", 10.0},
                                       {"P228_30kPa", 30.0},
                                       {"P228_100kPa", 100.0}}) {
    const Ensemble e = read_ensemble(study, ends, units, name);
    if (e.norm.value.size() < 2) continue;
    table.row({pressure, 1e3 * pressure * units.thickness / units.stiffness,
               static_cast<double>(e.seeds), static_cast<double>(e.norm.value.size()),
               e.fraction.mean(), e.norm.mean(), e.norm.deviation(), e.norm.error()});
    ++count;
  }
  if (count == 0) return;
  table.print();
  table.write(study.results / "sizes_pressure.csv");
}

void reach_of_t(const PaperStudy& study, const Ends& ends, const PaperUnits& units) {
  Table table("How far T carries, ensembles",
              {"initial_pressure[kPa]", "packing[-]", "seeds[-]", "equilibrium_at_rest[-]",
               "F12_reached_mean[-]", "F12_reached_least[-]", "F12_reached_most[-]"});
  int count = 0;
  for (const char* pressure : {"10", "100"})
    for (const int size : sizes) {
      const Ensemble e =
          read_ensemble(study, ends, units, fmt::format("T{}_{}kPa", size, pressure));
      if (e.seeds == 0) continue;
      const auto [least, most] =
          std::minmax_element(e.reached.value.begin(), e.reached.value.end());
      table.row({pressure, fmt::format("{}", size), static_cast<double>(e.seeds),
                 static_cast<double>(e.carried), e.reached.mean(), *least, *most});
      ++count;
    }
  if (count == 0) return;
  table.print();
  table.write(study.results / "sizes_reach_of_t.csv");
}

}  // namespace

void study_sizes(PaperStudy& study) {
  const PaperUnits units = read_units(study.scenes / "pack_228.toml");
  const Ends ends{CaseEnds(study.results / "sizes_cases.csv"),
                  CaseEnds(study.results / "sizes_rough_cases.csv")};
  add_facts(study, stress_norms(study, ends, units));
  initial_pressures(study, ends, units);
  reach_of_t(study, ends, units);
}

}  // namespace verification

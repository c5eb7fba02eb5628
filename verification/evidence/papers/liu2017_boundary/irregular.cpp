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

// What D, P and T share at the packing near 228 discs; orders over their common steps.
void facts_of_228(PaperStudy& study, const PaperUnits& units) {
  const auto d = study.run("figure_08_D"), p = study.run("figure_08_P"),
             t = study.run("figure_08_T");
  for (const auto& [name, run] : {std::pair{"D", &d}, {"P", &p}, {"T", &t}}) {
    if (!*run) continue;
    const double s11 = mean((*run)->column("sigma11", -1)),
                 s22 = mean((*run)->column("sigma22", -1));
    const double shear = mean((*run)->column("sigma12"));
    study.facts.add(fmt::format("figure_08.{}.reached", name), (*run)->history["F12"].back());
    study.facts.add(fmt::format("figure_08.{}.shear_over_normal", name), 2 * shear / (s11 + s22));
    study.facts.add(fmt::format("figure_08.{}.sigma11_over_sigma22", name), s11 / s22);
    study.facts.add(fmt::format("figure_08.{}.escaped", name),
                    (*run)->history["escaped_particles"].back());
  }
  if (d && p) study.facts.add("order.figure_08.D_over_P", compare(*d, *p, units).share);
  if (p && t) study.facts.add("order.figure_08.P_over_T", compare(*p, *t, units).share);
  if (!d || !p || !t || !d->particles || !p->particles || !t->particles) return;
  const std::size_t common = std::min({d->steps(), p->steps(), t->steps()});
  const auto at = [&](const PaperRun& run, const char* what) {
    std::vector<double> values = (*run.particles)[what];
    values.resize(std::min(values.size(), common));
    return mean(values);
  };
  const auto ordered = [](double most, double middle, double least) {
    return most >= middle && middle >= least ? 1 : 0;
  };
  const char *overlap = "normalised_overlap", *rotation = "mean_rotation_magnitude";
  study.facts.add("figure_08.common_until", t->history["F12"][common - 1]);
  study.facts.add("figure_08.overlap_order",
                  ordered(at(*d, overlap), at(*p, overlap), at(*t, overlap)));
  study.facts.add("figure_08.rotation_order",
                  ordered(at(*t, rotation), at(*p, rotation), at(*d, rotation)));
}

// The stress norm in steps a quarter as long, apart before and after its largest value, over that.
void step_size(PaperStudy& study, const PaperUnits& units) {
  double before = std::nan(""), after = std::nan("");
  for (const char* name : {"D", "P", "T"}) {
    const auto coarse = study.run(std::string("figure_08_") + name),
               fine = study.run(fmt::format("figure_08_{}_fine", name));
    if (!coarse || !fine) continue;
    const std::vector<double> norm = stress_norm(*coarse, units), other = stress_norm(*fine, units);
    const auto top = std::max_element(norm.begin(), norm.end());
    const std::vector<double>&x = coarse->history["F12"], &finer = fine->history["F12"];
    for (std::size_t k = 0; k < norm.size() && x[k] <= finer.back() + 1e-9; ++k) {
      const double apart =
          std::abs(interpolate(finer, other, std::min(x[k], finer.back())) - norm[k]);
      double& largest = norm.begin() + static_cast<std::ptrdiff_t>(k) <= top ? before : after;
      largest = std::fmax(largest, apart / *top);
    }
  }
  study.facts.add("figure_08.fine.apart_before_peak", before);
  study.facts.add("figure_08.fine.apart_after_peak", after);
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
    double least = INFINITY;
    for (const int size : sizes) {
      const auto k = ends.find(fmt::format("figure_10_T{}{}", size, suffix));
      if (!k) continue;
      const double shear = ends.table["F12"][*k];
      table.row({pressure, fmt::format("{}", size), ends.table["particles"][*k], shear,
                 ends.table["steps"][*k], how(ends, *k)});
      least = std::min(least, shear);
    }
    study.facts.add(*suffix == 0 ? "figure_10.T.reached_least" : "figure_10.T100kPa.reached_least",
                    least);
  }
  table.print();
  table.write(study.results / "reach_of_t.csv");
}

void figure_10(PaperStudy& study, const PaperUnits& units, const CaseEnds& ends) {
  Table table("Stress norm of eq. 42", {"condition", "packing[-]", "particles[-]", "stress_norm[-]",
                                        "until_F12[-]", "stress_norm_start[-]"});
  Panel panel{"|σ R / kn|, L2 over the path [-]", {}, 1.5};
  std::array<std::vector<double>, 4> norms;
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

  for (const auto& [name, values] :
       {std::pair{"D", &norms[0]}, {"P", &norms[1]}, {"T", &norms[2]}, {"P_one", &norms[3]}}) {
    if (values->size() != sizes.size()) continue;
    study.facts.add(fmt::format("figure_10.{}.norm_mean", name), mean(*values));
    study.facts.add(fmt::format("figure_10.{}.spread", name), spread(*values));
    study.facts.add(fmt::format("figure_10.{}.largest_rise", name), largest_rise(*values));
    study.facts.add(fmt::format("figure_10.{}.least_rise", name), least_rise(*values));
  }
}

}  // namespace

void study_irregular_packings(PaperStudy& study) {
  const PaperUnits units = read_units(study.scenes / "pack_228.toml");
  const CaseEnds ends(study.results / "figure_10_cases.csv");
  figure_7(study, units);
  figure_9(study);
  facts_of_228(study, units);
  step_size(study, units);
  figure_10(study, units, ends);
  reach_of_t(study, ends);
}

}  // namespace verification

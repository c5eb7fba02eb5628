#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

struct Line {
  const char* name;  // of the run
  const char* title;
  const char* colour;
  Stroke stroke = Stroke::solid;
};

// One panel per quantity; runs that are not there are left out.
void draw_runs(const PaperStudy& study, const std::string& title, const std::vector<Line>& lines,
               bool stresses, const char* name) {
  Panel first{stresses ? "stress ratio [-]" : "coordination [-]"};
  Panel second{stresses ? "volume, J / J of the start - 1 [-]" : "anisotropy [-]"};
  for (const Line& line : lines) {
    const auto run = load_biaxial(study, line.name);
    if (!run) continue;
    first.curves.push_back({line.title, run->strain, stresses ? run->ratio : run->coordination,
                            line.colour, line.stroke});
    second.curves.push_back(
        {"", run->strain, stresses ? run->volume : run->anisotropy, line.colour, line.stroke});
  }
  if (!first.curves.empty())
    draw({title, "axial strain [-]", {first, second}}, study.results / name);
}

const std::vector<Line> meshes{{"dns_a", "DNS A", colour::black, Stroke::dashed},
                               {"dns_b", "DNS B", colour::black},
                               {"biaxial_1x1", "1 x 1", colour::amber},
                               {"biaxial_1x2", "1 x 2", colour::orange},
                               {"biaxial_2x4", "2 x 4", colour::blue},
                               {"biaxial_4x8", "4 x 8", colour::green, Stroke::dashed},
                               {"biaxial_4x8_membrane", "4 x 8, membranes", colour::green}};
const std::vector<Line> frictions{{"friction_02", "friction 0.2", colour::amber},
                                  {"biaxial_2x4", "friction 0.4", colour::blue},
                                  {"friction_06", "friction 0.6", colour::green}};
const std::vector<Line> rotations{{"biaxial_2x4", "free rotation", colour::blue},
                                  {"locked", "no rotation", colour::orange}};

std::vector<Biaxial> load_all(const PaperStudy& study, const std::vector<Line>& lines) {
  std::vector<Biaxial> runs;
  for (const Line& line : lines)
    if (auto run = load_biaxial(study, line.name)) runs.push_back(std::move(*run));
  return runs;
}

double peak_of(const Biaxial& run) { return run.ratio[run.peak()]; }
double compaction(const Biaxial& run) {
  return *std::min_element(run.volume.begin(), run.volume.end());
}

template <class Value>
std::string list(const std::vector<Biaxial>& runs, Value&& value, const char* format = "{:.3f}") {
  std::string text;
  for (const Biaxial& run : runs)
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(format), value(run));
  return text;
}

template <class Value>
bool rising(const std::vector<Biaxial>& runs, Value&& value) {
  return std::is_sorted(runs.begin(), runs.end(),
                        [&](const Biaxial& a, const Biaxial& b) { return value(a) < value(b); });
}

// Meshes against the coarsest, up to its own and their peaks.
void compare_meshes(PaperStudy& study) {
  const std::vector<Biaxial> all = load_all(study, meshes);
  Table table("Peaks", {"run", "peak_ratio[-]", "strain_at_peak[-]", "largest_compaction[-]",
                        "coordination_start[-]", "coordination_peak[-]", "anisotropy_start[-]",
                        "anisotropy_peak[-]", "until_strain[-]"});
  for (const std::vector<Line>* lines : {&meshes, &frictions, &rotations})
    for (const Line& line : *lines) {
      if (lines != &meshes && std::string(line.name).find("biaxial") == 0) continue;
      const auto run = load_biaxial(study, line.name);
      if (!run) continue;
      const std::size_t p = run->peak();
      table.row({line.name, run->ratio[p], run->strain[p], compaction(*run),
                 run->coordination.front(), run->coordination[p], run->anisotropy.front(),
                 run->anisotropy[p], run->strain.back()});
    }
  table.print();
  table.write(study.results / "peaks.csv");
  const auto coarse = load_biaxial(study, "biaxial_1x1");
  if (!coarse) return;
  for (const char* mesh : {"1x2", "2x4", "4x8", "4x8_membrane"}) {
    const auto run = load_biaxial(study, std::string("biaxial_") + mesh);
    if (!run) continue;
    const double until = std::min(coarse->strain[coarse->peak()], run->strain[run->peak()]);
    double largest = 0, at = 0, same_until = 0;
    for (std::size_t k = 0; k < run->strain.size() && run->strain[k] <= until; ++k) {
      const double difference = std::abs(run->ratio[k] - coarse->ratio_at(run->strain[k]));
      if (difference < 1e-4 && same_until == at) same_until = run->strain[k];
      at = run->strain[k];
      largest = std::max(largest, difference);
    }
    study.facts.agree("4",
                      fmt::format("mesh {} against 1x1, largest difference of the ratio "
                                  "before the peak",
                                  mesh),
                      "none to see",
                      fmt::format("{:.2g}; below 1e-4 up to strain {:.3f}", largest, same_until),
                      largest < 0.01);
  }
  if (all.size() > 2)
    study.facts.add("4", "peak stress ratio: DNS A, B, meshes", "0.39 (2x4)", list(all, peak_of),
                    "-");
}

void compare_parameters(PaperStudy& study) {
  if (const auto runs = load_all(study, frictions); runs.size() == frictions.size()) {
    study.facts.agree("8", "peak ratio, friction 0.2, 0.4, 0.6", "rises", list(runs, peak_of),
                      rising(runs, peak_of));
    const auto minus = [](const Biaxial& run) { return -compaction(run); };
    study.facts.agree("8", "largest compaction, friction 0.2, 0.4, 0.6", "rises",
                      list(runs, minus, "{:.4f}"), rising(runs, minus));
    const auto middle = [](const Biaxial& run) {
      return interpolate(run.strain, run.coordination, 0.03);
    };
    const auto lower = [&](const Biaxial& run) { return -middle(run); };
    study.facts.agree("9", "coordination at strain 0.03, friction 0.2, 0.4, 0.6", "falls",
                      list(runs, middle), rising(runs, lower));
  }
  if (const auto runs = load_all(study, rotations); runs.size() == rotations.size()) {
    const double factor = peak_of(runs[1]) / peak_of(runs[0]);
    study.facts.agree(
        "10", "peak ratio without rotation / with", "0.48 / 0.39 = 1.23",
        fmt::format("{:.3f} / {:.3f} = {:.2f}", peak_of(runs[1]), peak_of(runs[0]), factor),
        factor > 1.15);
    study.facts.agree("10", "largest compaction: free, no rotation", "more without rotation",
                      list(runs, compaction, "{:.4f}"), compaction(runs[1]) < compaction(runs[0]));
    const auto at = [](const Biaxial& run) {
      return interpolate(run.strain, run.anisotropy, std::min(0.073, run.strain.back()));
    };
    study.facts.add("11", "anisotropy at strain 0.073: free, no rotation", "0.27, 0.33",
                    list(runs, at, "{:.2f}"), "-");
    const auto last = [](const Biaxial& run) {
      return interpolate(run.strain, run.coordination, 0.03);
    };
    study.facts.agree("11", "coordination at strain 0.03: free, no rotation",
                      "smaller without rotation", list(runs, last), last(runs[1]) < last(runs[0]));
  }
}

}  // namespace

std::size_t Biaxial::peak() const {
  return static_cast<std::size_t>(std::max_element(ratio.begin(), ratio.end()) - ratio.begin());
}

double Biaxial::ratio_at(double at) const { return interpolate(strain, ratio, at); }

std::optional<Biaxial> load_biaxial(const PaperStudy& study, const std::string& name,
                                    std::size_t first) {
  const auto run = study.run(name);
  if (!run || run->steps() < first + 2) return std::nullopt;
  const CsvTable& h = run->history;
  Biaxial test;
  test.name = name;
  const double start = h["F22"][first], volume = 1 + h["volumetric_strain"][first];
  for (std::size_t k = first; k < h.rows(); ++k) {
    const double s1 = h["sigma11"][k], s2 = h["sigma22"][k];
    const double strain = 1 - h["F22"][k] / start;
    if (k > first && strain <= test.strain.back()) continue;  // a step that brings loads on only
    test.strain.push_back(strain);
    test.ratio.push_back(std::abs((s1 - s2) / (s1 + s2)));
    test.volume.push_back((1 + h["volumetric_strain"][k]) / volume - 1);
    test.coordination.push_back(h["coordination"][k]);
    test.anisotropy.push_back(h["anisotropy"][k]);
  }
  return test;
}

void study_biaxial(PaperStudy& study) {
  draw_runs(study, "Fig. 4: meshes and direct simulations", meshes, true, "figure_04");
  draw_runs(study, "Fig. 5: meshes and direct simulations", meshes, false, "figure_05");
  draw_runs(study, "Fig. 8: friction", frictions, true, "figure_08");
  draw_runs(study, "Fig. 9: friction", frictions, false, "figure_09");
  draw_runs(study, "Fig. 10: rotation", rotations, true, "figure_10");
  draw_runs(study, "Fig. 11: rotation", rotations, false, "figure_11");
  draw_points(study);
  compare_meshes(study);
  compare_parameters(study);
  study_initial_anisotropy(study);
  compare_with_direct(study);
  compare_sizes(study);
  tabulate_costs(study);
}

void add_liu2019_biaxial_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = app.add_subcommand(
      "liu2019_biaxial", "figures and tables of the scenes of this name, which were run before");
  command->callback([options] {
    PaperStudy papers{
        std::filesystem::path(options->scenes) / "liu2019_biaxial", options->output, {}};
    study_biaxial(papers);
    papers.facts.print();
    papers.facts.write(papers.results / "liu2019_biaxial_facts.csv");
  });
}

}  // namespace verification

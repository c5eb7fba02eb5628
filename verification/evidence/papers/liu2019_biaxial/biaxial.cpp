#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

constexpr double marked = 0.073;  // strain at which the paper gives numbers [-]

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
std::vector<double> values_of(const std::vector<Biaxial>& runs, Value&& value) {
  std::vector<double> values;
  for (const Biaxial& run : runs) values.push_back(value(run));
  return values;
}

// Largest |a - b| of the stress ratio over the strains in a range.
double apart(const Biaxial& a, const Biaxial& b, double from, double to) {
  double largest = std::nan("");
  for (std::size_t k = 0; k < a.strain.size(); ++k)
    if (a.strain[k] >= from && a.strain[k] <= to)
      largest = std::fmax(largest, std::abs(a.ratio[k] - b.ratio_at(a.strain[k])));
  return largest;
}

// What one run is like by itself.
void add_facts(PaperStudy& study, const Biaxial& run) {
  const auto add = [&](const char* fact, double value) {
    study.facts.add(fmt::format(fmt::runtime(fact), run.name), value);
  };
  const std::size_t p = run.peak();
  const auto largest = std::max_element(run.anisotropy.begin(), run.anisotropy.end());
  const auto least = std::min_element(run.volume.begin(), run.volume.end());
  const auto strain_at = [&](const auto& first, const auto& at) {
    return run.strain[static_cast<std::size_t>(at - first)];
  };
  add("{}.peak", run.ratio[p]);
  add("{}.peak_at", run.strain[p]);
  add("{}.end_over_peak", run.ratio.back() / run.ratio[p]);
  add("{}.until_strain", run.strain.back());
  add("{}.coordination_start", run.coordination.front());
  add("{}.coordination_end_over_start", run.coordination.back() / run.coordination.front());
  add("{}.anisotropy_start", run.anisotropy.front());
  add("{}.anisotropy_peak_less_peak_at",
      strain_at(run.anisotropy.begin(), largest) - run.strain[p]);
  add("{}.anisotropy_end_over_peak", run.anisotropy.back() / *largest);
  add("{}.compaction_at", strain_at(run.volume.begin(), least));
  for (const char* end : {"_cost.csv", ".csv"}) {
    const auto path = study.results / (run.name + end);
    if (run.name.find("dns") != 0 || !std::filesystem::exists(path)) continue;
    const CsvTable table = read_csv(path);
    for (const auto& [column, fact] :
         {std::pair{"particles", "{}.particles"}, {"escaped_particles", "{}.escaped"}})
      if (std::find(table.names.begin(), table.names.end(), column) != table.names.end())
        add(fact, table[column].back());
  }
}

// Meshes against the coarsest, up to its own and their peaks.
void compare_meshes(PaperStudy& study) {
  Table table("Peaks", {"run", "peak_ratio[-]", "strain_at_peak[-]", "largest_compaction[-]",
                        "coordination_start[-]", "coordination_peak[-]", "anisotropy_start[-]",
                        "anisotropy_peak[-]", "until_strain[-]"});
  for (const std::vector<Line>* lines : {&meshes, &frictions, &rotations})
    for (const Line& line : *lines) {
      if (lines != &meshes && std::string(line.name).find("biaxial") == 0) continue;
      const auto run = load_biaxial(study, line.name);
      if (!run) continue;
      add_facts(study, *run);
      const std::size_t p = run->peak();
      table.row({line.name, run->ratio[p], run->strain[p], compaction(*run),
                 run->coordination.front(), run->coordination[p], run->anisotropy.front(),
                 run->anisotropy[p], run->strain.back()});
    }
  table.print();
  table.write(study.results / "peaks.csv");
  const auto coarse = load_biaxial(study, "biaxial_1x1");
  if (!coarse) return;
  double coordination = std::nan("");
  for (const char* mesh : {"1x2", "2x4", "4x8", "4x8_membrane"}) {
    const auto run = load_biaxial(study, std::string("biaxial_") + mesh);
    if (!run) continue;
    const double until = std::min(coarse->strain[coarse->peak()], run->strain[run->peak()]);
    study.facts.add(fmt::format("biaxial_{}.apart_before_peak", mesh),
                    apart(*run, *coarse, 0, until));
    study.facts.add(fmt::format("biaxial_{}.apart_after_peak", mesh),
                    apart(*run, *coarse, until, coarse->strain.back()));
    coordination = std::fmax(coordination,
                             std::abs(run->coordination.back() / coarse->coordination.back() - 1));
  }
  study.facts.add("meshes.coordination_apart", coordination);
}

void compare_parameters(PaperStudy& study) {
  if (const auto runs = load_all(study, frictions); runs.size() == frictions.size()) {
    const auto at = [](const Biaxial& run) {
      return interpolate(run.strain, run.coordination, 0.03);
    };
    const auto end = [](const Biaxial& run) {
      return run.coordination.back() / run.coordination.front();
    };
    const auto fabric = [](const Biaxial& run) { return run.anisotropy[run.peak()]; };
    const std::vector<double> ends = values_of(runs, end);
    study.facts.add("friction.peak_least_rise", least_rise(values_of(runs, peak_of)));
    study.facts.add("friction.compaction_least_rise", least_rise(values_of(runs, compaction)));
    study.facts.add("friction.coordination_largest_rise", largest_rise(values_of(runs, at)));
    study.facts.add("friction.anisotropy_least_rise", least_rise(values_of(runs, fabric)));
    study.facts.add("friction.coordination_end_over_start_most",
                    *std::max_element(ends.begin(), ends.end()));
  }
  if (const auto runs = load_all(study, rotations); runs.size() == rotations.size()) {
    const Biaxial &free = runs[0], &locked = runs[1];
    const auto fabric = [](const Biaxial& run) {
      return interpolate(run.strain, run.anisotropy, marked);
    };
    const auto contacts = [](const Biaxial& run) {
      return interpolate(run.strain, run.coordination, 0.03);
    };
    const double gain = peak_of(locked) / peak_of(free);
    study.facts.add("rotation.gain", gain);
    study.facts.add("rotation.free_0.073", free.ratio_at(marked));
    study.facts.add("rotation.locked_0.073", locked.ratio_at(marked));
    study.facts.add("rotation.compaction_ratio", compaction(locked) / compaction(free));
    study.facts.add("rotation.coordination_ratio", contacts(locked) / contacts(free));
    study.facts.add("rotation.anisotropy_free", fabric(free));
    study.facts.add("rotation.anisotropy_locked", fabric(locked));
    study.facts.add("rotation.strength_over_anisotropy", gain * fabric(free) / fabric(locked));
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
  count_made_packings(study);
  compare_with_direct(study);
  compare_sizes(study);
  tabulate_costs(study);
}

void add_liu2019_biaxial_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = app.add_subcommand(
      "liu2019_biaxial", "figures and tables of the scenes of this name, which were run before");
  command->callback([options] {
    PaperStudy papers{std::filesystem::path(options->scenes) / "liu2019_biaxial", options->output,
                      Facts("liu2019")};
    study_biaxial(papers);
    papers.facts.write(papers.results);
  });
}

}  // namespace verification

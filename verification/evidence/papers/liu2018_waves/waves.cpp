#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {

void WaveStudy::add(const std::string& figure, const std::string& quantity,
                    const std::string& paper, const std::string& here, const std::string& verdict) {
  facts.add(figure, quantity, paper, here, verdict);
}

void WaveStudy::agree(const std::string& figure, const std::string& quantity,
                      const std::string& paper, const std::string& here, bool yes) {
  add(figure, quantity, paper, here, yes ? "agrees" : "differs");
}

std::string WaveStudy::errors(const std::string& scene, const std::vector<int>& meshes,
                              double amplitude, std::vector<double>* last) const {
  std::string text;
  const Run particles = load(scene + "_dns");
  for (const char* section : {"displacement_1", "displacement_2"}) {
    std::string list;
    double error = 0;
    for (const int divisions : meshes) {
      const Run mesh = load(fmt::format("{}_fe{}", scene, divisions));
      if (!mesh || !particles) continue;
      error = apart(*mesh, *particles, section, amplitude);
      list += fmt::format("{}{:.2f}", list.empty() ? "" : " / ", 100 * error);
    }
    text += fmt::format("{}{} %", text.empty() ? "" : "; ", list);
    if (last != nullptr) last->push_back(error);
  }
  return text;
}

double apart(const PaperRun& a, const PaperRun& b, const char* section, double amplitude) {
  double largest = 0;
  for (std::size_t k = 0; k < a.steps(); ++k) {
    const double other = interpolate(b.history["time"], b.history[section], a.history["time"][k]);
    if (std::isfinite(other))
      largest = std::max(largest, std::abs(a.history[section][k] - other) / amplitude);
  }
  return largest;
}

double arrival(const PaperRun& run, const char* section, double amplitude) {
  const auto& u = run.history[section];
  for (std::size_t k = 1; k < u.size(); ++k)
    if (u[k] >= 0.5 * amplitude) {
      const auto& time = run.history["time"];
      const double share = (0.5 * amplitude - u[k - 1]) / (u[k] - u[k - 1]);
      return 1e3 * (time[k - 1] + share * (time[k] - time[k - 1]));
    }
  return std::nan("");
}

Curve wave_curve(const PaperRun& run, const char* column, double factor, const char* colour,
                 Stroke stroke, const std::string& title) {
  return {title, run.column("time", 1e3), run.column(column, factor), colour, stroke};
}

void study_wave_cost(WaveStudy& study) {
  Table table("What the runs cost",
              {"run[-]", "elements[-]", "particles[-]", "steps[-]", "cuts[-]", "core_seconds[s]",
               "wall[s]", "error_near[% of A]", "error_far[% of A]"});
  double total = 0;
  for (const char* name : {"figure_4_4",      "figure_4_5_0.5ms", "figure_4_5_1ms",
                           "figure_4_5_2ms",  "figure_4_5_5ms",   "figure_4_6_layer",
                           "figure_4_6_free", "figure_4_7_layer", "figure_4_7_free",
                           "figure_4_8",      "figure_4_10",      "why_plain",
                           "why_damped",      "why_free",         "why_half",
                           "why_quarter",     "why_confined",     "why_confined_damped",
                           "why_periodic",    "why_bonded"}) {
    const WaveStudy::Run run = study.load(std::string(name) + "_cost");
    if (!run) continue;
    const CsvTable& cost = run->history;
    for (std::size_t k = 0; k < cost.rows(); ++k) {
      const auto at = [&](const char* column) { return cost[column][k]; };
      total += at("core_seconds");
      table.row({name, at("elements"), at("particles"), at("steps"), at("cuts"), at("core_seconds"),
                 at("wall"), 100 * at("largest_error_1"), 100 * at("largest_error_2")});
    }
  }
  table.write(study.results / "cost.csv");
  fmt::print("all runs together: {:.0f} core-seconds\n", total);
}

void add_liu2018_waves_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = study.add_subcommand(
      "liu2018_waves", "figures and tables of the waves in liu2018_waves, which were run before");
  command->callback([options] {
    WaveStudy waves(options->output);
    study_string_waves(waves);
    study_packing_waves(waves);
    study_why_waves_differ(waves);
    study_wave_cost(waves);
    waves.facts.print();
    waves.facts.write(waves.results / "liu2018_waves_facts.csv");
  });
}

}  // namespace verification

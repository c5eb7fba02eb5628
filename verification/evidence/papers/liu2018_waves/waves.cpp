#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {

std::vector<double> WaveStudy::errors(const std::string& mesh_scene, const std::string& particles,
                                      const std::vector<int>& meshes, int section,
                                      double amplitude) const {
  std::vector<double> found;
  const Run reference = load(particles);
  for (const int divisions : meshes)
    if (const Run mesh = load(fmt::format("{}_fe{}", mesh_scene, divisions)); mesh && reference)
      found.push_back(
          apart(*mesh, *reference, fmt::format("displacement_{}", section).c_str(), amplitude));
  return found;
}

void WaveStudy::add_errors(const std::string& name, const std::string& mesh_scene,
                           const std::string& particles, const std::vector<int>& meshes,
                           double amplitude) {
  const std::vector<double> near = errors(mesh_scene, particles, meshes, 1, amplitude),
                            far = errors(mesh_scene, particles, meshes, 2, amplitude);
  if (near.size() != meshes.size()) return;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    facts.add(fmt::format("{}.near_{}", name, meshes[k]), near[k]);
    facts.add(fmt::format("{}.far_{}", name, meshes[k]), far[k]);
  }
  facts.add(fmt::format("{}.near_finest", name), near.back());
  facts.add(fmt::format("{}.far_finest", name), far.back());
  facts.add(fmt::format("{}.growth_near", name), largest_rise(near));
  facts.add(fmt::format("{}.growth_far", name), largest_rise(far));
  facts.add(fmt::format("{}.growth", name), std::max(largest_rise(near), largest_rise(far)));
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
  for (const char* name : {"figure_4_4",         "figure_4_5_0.5ms",
                           "figure_4_5_1ms",     "figure_4_5_2ms",
                           "figure_4_5_5ms",     "figure_4_6_layer",
                           "figure_4_6_free",    "figure_4_7_layer",
                           "figure_4_7_free",    "figure_4_8",
                           "figure_4_10",        "why_plain",
                           "why_damped",         "why_free",
                           "why_half",           "why_quarter",
                           "why_confined",       "why_confined_damped",
                           "why_periodic",       "why_bonded",
                           "inertia_loose",      "inertia_loose_coarse",
                           "inertia_loose_fine", "inertia_loose_short",
                           "inertia_loose_long", "inertia_loose_periodic",
                           "inertia_bonded",     "inertia_bonded_coarse"}) {
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
    study_waves_with_inertia(waves);
    study_further_waves(waves, std::filesystem::path(options->scenes) / "liu2018_waves");
    study_wave_cost(waves);
    waves.facts.write(waves.results);
  });
}

}  // namespace verification

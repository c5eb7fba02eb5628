// What the scenes of guo2014_multiscale cost, beside the paper's times, and what more points, particles or
// steps buy.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

namespace verification {
namespace {

struct Scene {
  const char* name;
  double points;
  double particles;
  double planned;  // load steps; of cyclic tests, which end by themselves, at most
  const char* paper;
};
constexpr std::array<Scene, 24> scenes{
    {{"element_exact", 4, 400, 100, ""},
     {"element_elastic", 4, 400, 55, "-"},
     {"element_perturbed", 4, 400, 55, "-"},
     {"biaxial_2x4", 32, 400, 100, ""},
     {"biaxial_2x4_100", 32, 100, 20, ""},
     {"biaxial_2x4_coarse", 32, 400, 8, ""},
     {"biaxial_2x4_fine", 32, 400, 80, ""},
     {"biaxial_2x4_full", 32, 400, 20, ""},
     {"biaxial_3x5", 60, 400, 100, ""},
     {"biaxial_3x5_full", 60, 400, 20, ""},
     {"biaxial_6x10", 240, 400, 100, "1.4 h on 16 cores (22.4 core-hours)"},
     {"biaxial_6x10_full", 240, 400, 20, ""},
     {"biaxial_6x10_fine", 240, 400, 80, ""},
     {"biaxial_10x15", 600, 400, 100, "3 h on 16 cores"},
     {"biaxial_12x20", 960, 400, 100, "4.5 h on 16 cores"},
     {"biaxial_6x10_q8", 540, 400, 100, "3 h on 16 cores"},
     {"biaxial_2x4_hexagonal", 32, 400, 50, ""},
     {"biaxial_6x10_hexagonal", 240, 400, 50, "-"},
     {"cyclic_strain_column", 2, 400, 620, ""},
     {"cyclic_strain_3x2", 24, 400, 620, ""},
     {"cyclic_strain_15x10", 600, 400, 620, "-"},
     {"cyclic_stress_column", 2, 400, 2400, ""},
     {"cyclic_stress_3x2", 24, 400, 1600, ""},
     {"cyclic_stress_15x10", 600, 400, 1600, "-"}}};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Mean of |a / b - 1| of the axial stress over the steps between two axial strains [-].
double error(const CsvTable& run, const CsvTable& reference, double from, double to) {
  const auto& strain = run["axial_strain"];
  const auto& stress = run["sigma22"];
  double total = 0;
  int count = 0;
  for (std::size_t k = 1; k < strain.size() && strain[k] < to + 1e-9; ++k) {
    if (strain[k] < from) continue;
    const double other = interpolate(reference["axial_strain"], reference["sigma22"], strain[k]);
    if (!std::isfinite(other)) continue;
    total += std::abs(stress[k] / other - 1);
    ++count;
  }
  return count > 0 ? total / count : std::nan("");
}

// Mean difference of the vertical stress over its start, step by step: cyclic tests on the same path.
double step_error(const CsvTable& run, const CsvTable& reference) {
  const auto& stress = run["sigma22"];
  const auto& other = reference["sigma22"];
  const std::size_t steps = std::min(stress.size(), other.size());
  double total = 0;
  for (std::size_t k = 1; k < steps; ++k) total += std::abs((stress[k] - other[k]) / other[0]);
  return steps > 1 ? total / static_cast<double>(steps - 1) : std::nan("");
}

constexpr double before_chaos = 0.015;  // axial strain; beyond it round-off grows [-]

// A run of the biaxial test that differs from the others in one respect.
struct Variant {
  const char* kind;
  const char* name;
};
constexpr std::array<Variant, 9> variants{{{"mesh", "biaxial_2x4"},
                                           {"mesh", "biaxial_3x5"},
                                           {"mesh", "biaxial_6x10"},
                                           {"mesh", "biaxial_10x15"},
                                           {"packing", "biaxial_2x4_100"},
                                           {"packing", "biaxial_2x4"},
                                           {"increment", "biaxial_2x4_coarse"},
                                           {"increment", "biaxial_2x4"},
                                           {"increment", "biaxial_2x4_fine"}}};

// Error before chaos against the packing alone in finer increments; core time per axial strain.
void draw_error(const HierarchicalStudy& study) {
  const auto reference = load_run(study.results, "rve_fine");
  if (!reference) return;
  Table table("Biaxial test to 1.5 % axial strain against one RVE in increments of 0.00625 %",
              {"varied", "scene", "core_time[s]", "error[-]"});
  Panel panel{"error of the axial stress to 1.5 % [-]", {}, 1, true};
  constexpr std::array<const char*, 3> kinds{"mesh", "packing", "increment"};
  constexpr std::array<const char*, 3> colours{colour::blue, colour::orange, colour::green};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    Curve curve{kinds[kind], {}, {}, colours[kind], Stroke::solid, 7};
    for (const Variant& variant : variants) {
      const auto run = load_mesh_run(study.results, variant.name);
      if (std::string_view(variant.kind) != kinds[kind] || !run || !run->cost) continue;
      double core = 0;
      for (std::size_t k = 1; k < run->steps(); ++k)
        if (run->history["axial_strain"][k] < before_chaos + 1e-9)
          core += (*run->cost)["core_time"][k];
      const double found = error(run->history, reference->history, 0, before_chaos);
      table.row({variant.kind, variant.name, core, found});
      curve.x.push_back(core);
      curve.y.push_back(found);
    }
    if (!curve.x.empty()) panel.curves.push_back(curve);
  }
  table.print();
  table.write(study.results / "error_biaxial.csv");
  if (panel.curves.empty()) return;
  draw({"error against run time", "core time [s]", {panel}, true}, study.results / "error_biaxial");
}

}  // namespace

void study_cost_of_scenes(HierarchicalStudy& study) {
  const auto rve = load_run(study.results, "rve");
  const auto lattice = load_lattice(study.results);
  const auto column = load_run(study.results, "cyclic_strain_column");
  const auto found_error = [&](std::string_view name, const CsvTable& history) {
    const auto has = [&](const char* part) { return name.find(part) != std::string_view::npos; };
    if (has("hexagonal") && lattice) return error(history, lattice->history, 0, before_chaos);
    if (has("cyclic_strain") && !has("column") && column)
      return step_error(history, column->history);
    if (!has("cyclic") && !has("hexagonal") && rve)
      return error(history, rve->history, 0, before_chaos);
    return std::nan("");
  };
  Table table("Scenes of guo2014_multiscale",
              {"scene", "points[-]", "particles[-]", "steps[-]", "of[-]", "wall[s]", "core_time[s]",
               "core_ms_per_point_step[ms]", "newton_iterations[-]", "cuts[-]", "loose_parts[-]",
               "fallbacks[-]", "error[-]", "paper"});
  for (const Scene& scene : scenes) {
    const auto run = load_mesh_run(study.results, scene.name);
    if (!run || run->steps() < 2) continue;
    const double steps = static_cast<double>(run->steps() - 1);
    const double nan = std::nan("");
    const double core = run->cost ? sum((*run->cost)["core_time"]) : nan;
    study.facts.add(fmt::format("{}.core_hours", scene.name), core / 3600);
    table.row({scene.name, scene.points, scene.particles, steps, scene.planned,
               run->cost ? sum((*run->cost)["elapsed"]) : nan, core,
               1e3 * core / (steps * scene.points), sum(run->history["newton_iterations"]),
               sum(run->history["step_cuts"]), sum(run->history["loose_parts"]),
               sum(run->history["history_advanced"]), found_error(scene.name, run->history),
               *scene.paper == 0 ? "-" : scene.paper});
  }
  table.print();
  table.write(study.results / "guo2014_multiscale_scenes.csv");
  draw_error(study);
}

}  // namespace verification

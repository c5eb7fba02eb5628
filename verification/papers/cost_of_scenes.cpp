// What the scenes of papers-004 cost, beside the paper's times, and what more points, particles or
// steps buy.

#include "papers/papers_004.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numeric>

namespace verification {
namespace {

struct Scene {
  const char* name;
  int points;
  int particles;
  int planned;  // load steps
  const char* paper;
};
constexpr std::array<Scene, 15> scenes{
    {{"drained", 4, 400, 100, "not stated"},
     {"biaxial_2x4", 32, 400, 100, ""},
     {"biaxial_2x4_100", 32, 100, 100, ""},
     {"biaxial_2x4_fine", 32, 400, 40, ""},
     {"biaxial_3x5", 60, 400, 100, ""},
     {"biaxial_6x10", 240, 400, 100, "1.4 h on 16 cores (22.4 core-hours)"},
     {"biaxial_10x15", 600, 400, 100, "3 h on 16 cores"},
     {"biaxial_12x20", 960, 400, 100, "4.5 h on 16 cores"},
     {"biaxial_6x10_q8", 540, 400, 100, "3 h on 16 cores"},
     {"biaxial_2x4_hexagonal", 32, 400, 100, ""},
     {"biaxial_6x10_hexagonal", 240, 400, 100, "not stated"},
     {"cyclic_strain_3x2", 24, 400, 490, ""},
     {"cyclic_strain_15x10", 600, 400, 490, "not stated"},
     {"cyclic_stress_3x2", 24, 400, 530, ""},
     {"cyclic_stress_15x10", 600, 400, 530, "not stated"}}};

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Mean of |a / b - 1| of the axial stress up to 1.5 % strain, before chaos sets in.
double error(const CsvTable& run, const CsvTable& reference) {
  const auto& strain = run["axial_strain"];
  const auto& stress = run["sigma22"];
  double total = 0;
  int count = 0;
  for (std::size_t k = 1; k < strain.size() && strain[k] < 0.015 + 1e-9; ++k) {
    const double other = interpolate(reference["axial_strain"], reference["sigma22"], strain[k]);
    if (!std::isfinite(other)) continue;
    total += std::abs(stress[k] / other - 1);
    ++count;
  }
  return count > 0 ? total / count : std::nan("");
}

}  // namespace

void study_cost_of_scenes(HierarchicalStudy& study) {
  const auto rve = load_run(study.results, "rve");
  Table table("Scenes of papers-004",
              {"scene", "points[-]", "particles[-]", "steps[-]", "of[-]", "wall[s]",
               "core_time[s]", "core_ms_per_point_step[ms]", "newton_iterations[-]", "cuts[-]",
               "loose_parts[-]", "fallbacks[-]", "error_against_rve[-]", "paper"});
  for (const Scene& scene : scenes) {
    const auto run = load_mesh_run(study.results, scene.name);
    if (!run || run->steps() < 2) continue;
    const double steps = static_cast<double>(run->steps() - 1);
    const double nan = std::nan("");
    const double core = run->cost ? sum((*run->cost)["core_time"]) : nan;
    const bool biaxial = std::string_view(scene.name).find("hexagonal") == std::string_view::npos &&
                         std::string_view(scene.name).find("cyclic") == std::string_view::npos;
    table.row({scene.name, scene.points, scene.particles, steps, scene.planned,
               run->cost ? sum((*run->cost)["elapsed"]) : nan, core,
               1e3 * core / (steps * scene.points), sum(run->history["newton_iterations"]),
               sum(run->history["step_cuts"]), sum(run->history["loose_parts"]),
               sum(run->history["history_advanced"]),
               rve && biaxial ? error(run->history, rve->history) : nan,
               *scene.paper == 0 ? "-" : scene.paper});
  }
  table.print();
  table.write(study.results / "papers_004_scenes.csv");
}

}  // namespace verification

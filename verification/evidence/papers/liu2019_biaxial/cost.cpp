// What every scene of liu2019_biaxial cost, and how far it is from direct simulation B.

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>

namespace verification {
namespace {

struct Scene {
  const char* name;
  int points;  // integration points; 0: direct simulation
};
constexpr Scene scenes[]{{"biaxial_1x1", 4},
                         {"biaxial_1x2", 8},
                         {"biaxial_2x4", 32},
                         {"biaxial_4x8", 128},
                         {"biaxial_4x8_membrane", 128},
                         {"friction_02", 32},
                         {"friction_06", 32},
                         {"locked", 32},
                         {"dns_a", 0},
                         {"dns_b", 0}};
constexpr int particles_of_point = 200;  // copies of a frame once

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Elapsed and processor time that the shell wrote, "elapsed,cpu" [s]; NaN without.
std::array<double, 2> read_time(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::array<double, 2> time{std::nan(""), std::nan("")};
  char comma = 0;
  if (!(file >> time[0] >> comma >> time[1])) return {std::nan(""), std::nan("")};
  return time;
}

// Root mean square of the difference of the stress ratio, before the first of the two peaks.
double distance(const Biaxial& run, const Biaxial& reference) {
  const double until = std::min(run.strain[run.peak()], reference.strain[reference.peak()]);
  double square = 0;
  int count = 0;
  for (double strain = 0.0025; strain <= until + 1e-9; strain += 0.0025, ++count)
    square += std::pow(run.ratio_at(strain) - reference.ratio_at(strain), 2);
  return count > 0 ? std::sqrt(square / count) : std::nan("");
}

}  // namespace

void tabulate_costs(const PaperStudy& study) {
  Table table("Cost", {"scene", "elapsed[s]", "core_seconds[s]", "points[-]", "particles[-]",
                       "steps[-]", "newton_iterations[-]", "cuts[-]", "loose[-]",
                       "history_advanced[-]", "until_strain[-]", "rms_from_DNS_B[-]"});
  const auto reference = load_biaxial(study, "dns_b");
  for (const Scene& scene : scenes) {
    const auto run = study.run(scene.name);
    const auto test = load_biaxial(study, scene.name);
    if (!run || !test) continue;
    auto time = read_time(study.results / (std::string(scene.name) + ".time"));
    double particles = scene.points * particles_of_point;
    if (scene.points == 0) {
      const CsvTable cost = read_csv(study.results / (std::string(scene.name) + "_cost.csv"));
      particles = cost["particles"].front();
      time = {cost["elapsed"].front(), cost["cpu"].front()};
    }
    // Other parameters have no direct simulation of their own.
    const bool comparable =
        std::string(scene.name).find("biaxial") == 0 || std::string(scene.name) == "dns_a";
    const CsvTable& h = run->history;
    table.row({scene.name, time[0], time[1], static_cast<double>(scene.points), particles,
               h["step"].back(), sum(h["newton_iterations"]), sum(h["step_cuts"]),
               sum(h["loose_parts"]), sum(h["history_advanced"]), test->strain.back(),
               comparable && reference ? distance(*test, *reference) : std::nan("")});
  }
  table.print();
  table.write(study.results / "costs.csv");
}

}  // namespace verification

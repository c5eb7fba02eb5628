// Figures 4.6 to 4.11: regular and irregular packings, with and without bonds.

#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

void compare_surfaces(WaveStudy& study, const std::string& scene, int finest, double amplitude,
                      const char* name) {
  const WaveStudy::Run layer = study.load(scene + "_layer_dns"),
                       free = study.load(scene + "_free_dns");
  const WaveStudy::Run mesh = study.load(fmt::format("{}_layer_fe{}", scene, finest));
  if (!layer || !free || !mesh) return;
  Figure figure{fmt::format("Fig. {}: surfaces of the specimen", name), "time [ms]", {}};
  for (const char* section : {"displacement_1", "displacement_2"}) {
    Panel panel{fmt::format("u / A at {} mm [-]", figure.panels.empty() ? "30.5" : "305"), {}, 1.2};
    panel.curves = {wave_curve(*free, section, 1 / amplitude, colour::orange, Stroke::solid,
                               "particles, free surfaces"),
                    wave_curve(*layer, section, 1 / amplitude, colour::black, Stroke::solid,
                               "particles, slice of a layer"),
                    wave_curve(*mesh, section, 1 / amplitude, colour::sky, Stroke::dashed,
                               fmt::format("{} elements", finest))};
    figure.panels.push_back(panel);
  }
  draw(figure, study.results / (scene + "_surfaces"));
}

void study_regular(WaveStudy& study) {
  const std::vector<int> bonded{40, 80, 160, 320}, loose{26, 52, 104, 208, 416};
  for (const char* surface : {"layer", "free"}) {
    study.add_errors(fmt::format("figure_4_6_{}", surface), "figure_4_6_layer",
                     fmt::format("figure_4_6_{}_dns", surface), bonded, 5e-3);
    study.add_errors(fmt::format("figure_4_7_{}", surface), "figure_4_7_layer",
                     fmt::format("figure_4_7_{}_dns", surface), loose);
  }
  compare_surfaces(study, "figure_4_6", 320, 5e-3, "4.6");
  compare_surfaces(study, "figure_4_7", 416, pulse_amplitude, "4.7");
}

// Stress of the particles' pulse near the end and far from it, P22 of the windows.
void add_stresses(WaveStudy& study, const std::string& scene) {
  const WaveStudy::Run run = study.load(scene + "_dns");
  if (!run) return;
  const auto ends = [&](const char* column) {
    return std::minmax_element(run->history[column].begin(), run->history[column].end());
  };
  const auto [near_least, near_most] = ends("P22_1");
  const auto [far_least, far_most] = ends("P22_2");
  study.facts.add(fmt::format("{}.tension_over_compression", scene),
                  std::max(0.0, *near_most) / -*near_least);
  study.facts.add(fmt::format("{}.compression_far_over_near", scene), *far_least / *near_least);
}

void study_irregular(WaveStudy& study) {
  study.add_errors("figure_4_8", "figure_4_8", "figure_4_8_dns", {40, 80, 160, 320});
  study.add_errors("figure_4_10", "figure_4_10", "figure_4_10_dns", {26, 52, 104, 208});
  add_stresses(study, "figure_4_8");
  add_stresses(study, "figure_4_10");
  const WaveStudy::Run mesh = study.load("figure_4_8_fe320"),
                       particles = study.load("figure_4_8_dns");
  if (!mesh || !particles) return;
  const double of_mesh = arrival(*mesh, "displacement_2", pulse_amplitude);
  study.facts.add("figure_4_8.shift_over_arrival",
                  arrival(*particles, "displacement_2", pulse_amplitude) / of_mesh - 1);
}

}  // namespace

void study_packing_waves(WaveStudy& study) {
  study_regular(study);
  study_irregular(study);
}

}  // namespace verification

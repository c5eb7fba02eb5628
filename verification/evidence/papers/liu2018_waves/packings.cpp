// Figures 4.6 to 4.11: regular and irregular packings, with and without bonds.

#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

void compare_surfaces(WaveStudy& study, const std::string& scene, int finest, double amplitude,
                      const char* name, const char* paper) {
  const WaveStudy::Run layer = study.load(scene + "_layer_dns"),
                       free = study.load(scene + "_free_dns");
  const WaveStudy::Run mesh = study.load(fmt::format("{}_layer_fe{}", scene, finest));
  if (!layer || !free || !mesh) return;
  study.add(name, "particles with free surfaces against the same mesh, at 30.5; 305 mm", paper,
            fmt::format("{:.1f}; {:.1f} %, and {:.3f} ms later at 305 mm; as a slice of a layer "
                        "{:.2f}; {:.2f} %, {:.3f} ms",
                        100 * apart(*mesh, *free, "displacement_1", amplitude),
                        100 * apart(*mesh, *free, "displacement_2", amplitude),
                        arrival(*free, "displacement_2", amplitude) -
                            arrival(*mesh, "displacement_2", amplitude),
                        100 * apart(*mesh, *layer, "displacement_1", amplitude),
                        100 * apart(*mesh, *layer, "displacement_2", amplitude),
                        arrival(*layer, "displacement_2", amplitude) -
                            arrival(*mesh, "displacement_2", amplitude)),
            "explained");
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
  std::vector<double> last;
  std::string text = study.errors("figure_4_6_layer", {40, 80, 160, 320}, 5e-3, &last);
  if (!last.empty() && last[0] > 0)
    study.agree("4.6", "bonds: meshes of 40 / 80 / 160 / 320 against particles, at 30.5; 305 mm",
                "converge to the particles", text, last[0] < 0.05 && last[1] < 0.05);
  compare_surfaces(study, "figure_4_6", 320, 5e-3, "4.6", "a small difference");
  last.clear();
  text = study.errors("figure_4_7_layer", {26, 52, 104, 208, 416}, pulse_amplitude, &last);
  if (!last.empty() && last[0] > 0)
    study.add("4.7",
              "no bonds: meshes of 26 / 52 / 104 / 208 / 416 against particles, at 30.5; 305 mm",
              "larger for finer meshes", text,
              last[0] < 0.01 && last[1] < 0.01 ? "explained" : "differs");
  compare_surfaces(study, "figure_4_7", 416, pulse_amplitude, "4.7", "unexplained difference");
}

void study_irregular(WaveStudy& study) {
  std::vector<double> last;
  std::string text = study.errors("figure_4_8", {40, 80, 160, 320}, pulse_amplitude, &last);
  if (!last.empty() && last[0] > 0)
    study.agree("4.8", "bonds: meshes of 40 / 80 / 160 / 320 against particles, at 30; 300 mm",
                "good agreement, a small time shift at 300 mm", text,
                last[0] < 0.1 && last[1] < 0.15);
  const WaveStudy::Run mesh = study.load("figure_4_8_fe320"),
                       particles = study.load("figure_4_8_dns");
  if (mesh && particles)
    study.add("4.8", "particles later than 320 elements, at 300 mm", "a small time shift",
              fmt::format("{:.3f} ms of {:.2f} ms",
                          arrival(*particles, "displacement_2", pulse_amplitude) -
                              arrival(*mesh, "displacement_2", pulse_amplitude),
                          arrival(*mesh, "displacement_2", pulse_amplitude)),
              "agrees");
  last.clear();
  text = study.errors("figure_4_10", {26, 52, 104, 208}, pulse_amplitude, &last);
  if (!last.empty() && last[0] > 0)
    study.agree("4.10", "no bonds: meshes of 26 / 52 / 104 / 208 against particles, 30; 300 mm",
                "significant difference", text, last[0] > 0.1);
}

}  // namespace

void study_packing_waves(WaveStudy& study) {
  study_regular(study);
  study_irregular(study);
}

}  // namespace verification

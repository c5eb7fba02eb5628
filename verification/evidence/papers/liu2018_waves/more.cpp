// Section 4.4.4 with larger volumes, late oscillations of coarse meshes, and a shear wave.

#include "app/material.hpp"
#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification {
namespace {

// Root of the mean square of what a line through the last of a curve leaves.
double late_fluctuation(const PaperRun& run, const char* column, double from) {
  const std::vector<double>&time = run.history["time"], &u = run.history[column];
  double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] < from) continue;
    const double t = time[k] - from;
    ++count, x += t, y += u[k], xx += t * t, xy += t * u[k], yy += u[k] * u[k];
  }
  const double slope = (count * xy - x * y) / (count * xx - x * x), mean = (y - slope * x) / count;
  return std::sqrt(std::max(0.0, (yy - mean * y - slope * xy) / count));
}

void larger_volumes(WaveStudy& study) {
  const WaveStudy::Run small = study.load("figure_4_8_fe80"),
                       large = study.load("figure_4_8_650_fe80");
  if (!small || !large) return;
  study.facts.add("figure_4_8.volumes_apart", std::max(apart(*large, *small, "displacement_1"),
                                                       apart(*large, *small, "displacement_2")));
}

void late_oscillations(WaveStudy& study) {
  constexpr double from = 7e-3;  // the last eighth [s]
  const WaveStudy::Run coarse = study.load("figure_4_8_fe40"),
                       fine = study.load("figure_4_8_fe320");
  if (!coarse || !fine) return;
  study.facts.add("figure_4_8.late_fluctuation_coarse_over_fine",
                  late_fluctuation(*coarse, "displacement_2", from) /
                      late_fluctuation(*fine, "displacement_2", from));
}

// Velocity between two probes against sqrt(G / rho) at F = I.
void shear_wave(WaveStudy& study, const std::filesystem::path& scenes) {
  constexpr double amplitude = 1e-4, apart = 300e-3, density = 2000;  // of the scene [m], [kg/m3]
  const WaveStudy::Run probes = study.load("shear_wave_probes");
  if (!probes) return;
  const double time =
      1e-3 * (arrival(*probes, "far_x", amplitude) - arrival(*probes, "near_x", amplitude));
  const SceneFile file(scenes / "shear_wave.toml");
  SceneTable table = file.root();
  State state(make_material(read_material_source(table)));
  const Evaluation rest = evaluate(state, Tensor::Identity(), GRAINLAW_WANT_TANGENT_EXACT);
  if (rest.status != GRAINLAW_OK) return;
  const double modulus = rest.tangent(1, 1);  // dP12 / dF12
  const double of_volume = density / (1 + measure_scalar(state.get(), GRAINLAW_VOID_RATIO));
  const double expected = std::sqrt(modulus / of_volume);
  study.facts.add("shear.velocity", apart / time);
  study.facts.add("shear.velocity_of_tangent", expected);
  study.facts.add("shear.velocity_apart", std::abs(apart / time / expected - 1));
}

}  // namespace

void study_further_waves(WaveStudy& study, const std::filesystem::path& scenes) {
  larger_volumes(study);
  late_oscillations(study);
  shear_wave(study, scenes);
}

}  // namespace verification

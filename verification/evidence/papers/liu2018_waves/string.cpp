// Figures 4.4 and 4.5: the string of bonded discs, and its dispersion.

#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace verification {
namespace {

// The string of figures 4.4 and 4.5.
struct String {
  double stiffness = 1e4, radius = 1.1e-3, near = 22e-3, far = 110e-3;
  double mass = 2000 * std::numbers::pi * radius * radius * 1e-3;

  [[nodiscard]] double velocity() const {  // thesis eq. 4.24
    return std::sqrt(4 * stiffness * radius * radius / mass);
  }
  [[nodiscard]] double highest() const { return 2 * std::sqrt(stiffness / mass); }
  [[nodiscard]] double wave_number(double omega) const {
    return std::asin(omega / highest()) / radius;
  }
};

void study_periods(WaveStudy& study) {
  Figure figure{"Fig. 4.5: pulses of four periods", "time [ms]", {}};
  constexpr std::array<const char*, 4> names{"0.5ms", "1ms", "2ms", "5ms"};
  constexpr std::array<const char*, 4> colours{colour::blue, colour::green, colour::purple,
                                               colour::amber};
  double worst = 0;
  for (const char* section : {"displacement_1", "displacement_2"}) {
    const bool first = figure.panels.empty();
    Panel panel{fmt::format("u / A at {} [-]", first ? "20 R" : "100 R"), {}, 1.2};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const WaveStudy::Run mesh = study.load(fmt::format("figure_4_5_{}_fe400", names[k]));
      const WaveStudy::Run particles = study.load(fmt::format("figure_4_5_{}_dns", names[k]));
      if (!mesh || !particles) continue;
      panel.curves.push_back(wave_curve(*mesh, section, 1 / pulse_amplitude, colours[k],
                                        Stroke::solid, fmt::format("T = {}", names[k])));
      panel.curves.push_back(wave_curve(*particles, section, 1 / pulse_amplitude, colour::black,
                                        Stroke::dashed, k == 0 ? "particles" : ""));
      worst = std::max(worst, apart(*mesh, *particles, section));
    }
    if (!panel.curves.empty()) figure.panels.push_back(panel);
  }
  if (figure.panels.empty()) return;
  draw(figure, study.results / "figure_4_5");
  study.facts.add("figure_4_5.largest", worst);
}

// Fourier transform of a displacement at this angular frequency [m s].
std::complex<double> transform(const PaperRun& run, const char* section, double omega) {
  const auto& time = run.history["time"];
  const auto& u = run.history[section];
  std::complex<double> sum = 0;
  for (std::size_t k = 1; k < time.size(); ++k)
    sum += u[k] * std::polar(1.0, -omega * time[k]) * (time[k] - time[k - 1]);
  return sum;
}

// Wave number by the phase between two sections, unwrapped from the long waves on.
std::vector<double> wave_numbers(const PaperRun& run, const std::vector<double>& omegas) {
  const String s;
  std::vector<double> numbers;
  double phase = 0;
  for (const double omega : omegas) {
    const double here =
        std::arg(transform(run, "displacement_1", omega) / transform(run, "displacement_2", omega));
    phase += std::remainder(here - phase, 2 * std::numbers::pi);
    numbers.push_back(phase / (s.far - s.near));
  }
  return numbers;
}

void study_dispersion(WaveStudy& study) {
  const String s;
  const WaveStudy::Run mesh = study.load("figure_4_5_0.5ms_fe400"),
                       particles = study.load("figure_4_5_0.5ms_dns");
  if (!mesh || !particles) return;
  std::vector<double> omegas, shown, exact;
  for (double share = 0.01; share <= 0.8; share += 0.0025) omegas.push_back(share * s.highest());
  const auto k_mesh = wave_numbers(*mesh, omegas), k_particles = wave_numbers(*particles, omegas);
  Curve of_particles{"particles", {}, {}, colour::orange, Stroke::solid};
  Curve of_mesh{"400 elements", {}, {}, colour::blue, Stroke::dashed};
  Curve closed{"closed form", {}, {}, colour::black, Stroke::thin};
  double worst = 0;
  for (std::size_t k = 0; k < omegas.size(); ++k) {
    const double right = s.wave_number(omegas[k]);
    for (Curve* curve : {&of_particles, &of_mesh, &closed})
      curve->x.push_back(omegas[k] / s.highest());
    of_particles.y.push_back(omegas[k] / k_particles[k]);
    of_mesh.y.push_back(omegas[k] / k_mesh[k]);
    closed.y.push_back(omegas[k] / right);
    if (omegas[k] < 0.5 * s.highest())
      worst =
          std::max({worst, std::abs(k_particles[k] / right - 1), std::abs(k_mesh[k] / right - 1)});
  }
  Figure figure{"Dispersion of the string", "ω / highest ω [-]", {}};
  figure.panels.push_back({"phase velocity [m/s]", {closed, of_particles, of_mesh}, 1.4});
  draw(figure, study.results / "dispersion");
  study.facts.add("dispersion.largest_deviation", worst);
  const WaveStudy::Run slow = study.load("figure_4_5_5ms_dns"),
                       slow_mesh = study.load("figure_4_5_5ms_fe400");
  if (!slow || !slow_mesh) return;
  const std::vector<double> low{2 * std::numbers::pi / 5e-3};
  study.facts.add("velocity.particles", low[0] / wave_numbers(*slow, low)[0]);
  study.facts.add("velocity.mesh", low[0] / wave_numbers(*slow_mesh, low)[0]);
  study.facts.add("velocity.closed_form", s.velocity());
}

}  // namespace

void study_string_waves(WaveStudy& study) {
  study.add_errors("figure_4_4", "figure_4_4", "figure_4_4_dns", {40, 80, 200, 400});
  study_periods(study);
  study_dispersion(study);
}

}  // namespace verification

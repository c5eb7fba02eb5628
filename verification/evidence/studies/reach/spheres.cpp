#include "evidence/studies/reach/spheres.hpp"

#include "evidence/studies/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification::reach {
namespace {

using Tensor3 = std::array<double, 9>;
using Tangent3 = std::array<double, 81>;

constexpr double start_pressure = 1e5;   // [Pa]
constexpr double least_pressure = 0.01;  // of that; below, increments lead nowhere
constexpr double steepest_answer = 2;    // |dF11 / dF33| of the kept lateral stress, at most

double volume_ratio(const Tensor3& F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

double pressure(const Tensor3& P, const Tensor3& F) {
  double work = 0;
  for (std::size_t k = 0; k < 9; ++k) work += P[k] * F[k];
  return -work / (3 * volume_ratio(F));
}

Ending ending(const grainlaw::Evaluation& result) {
  if (result.status != GRAINLAW_OK) return Ending::failed;
  if (result.report.history_advanced != 0) return Ending::advanced;
  return result.report.subincrements > 1 ? Ending::subincrements : Ending::direct;
}

struct Point {
  Tensor3 F{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Tensor3 P{};
  Tangent3 A{};
};

// Change of F11 and F22 over that of -F33 which brings the mean lateral stress back to `lateral`.
double lateral_answer(const Point& at, double lateral, double size) {
  const auto& F = at.F;
  const double s11 = at.P[0] / (F[4] * F[8]);
  const double s22 = at.P[4] / (F[0] * F[8]);
  const auto by = [&](std::size_t column) {
    return 0.5 * (at.A[column] / (F[4] * F[8]) + at.A[4 * 9 + column] / (F[0] * F[8]));
  };
  const double mean = 0.5 * (s11 + s22);
  const double by_lateral = by(0) + by(4) - 0.5 * (s11 / F[4] + s22 / F[0]);
  const double by_axial = by(8) - mean / F[8];
  const double answer = (lateral - mean + by_axial * size) / (by_lateral * size);
  return std::isfinite(answer) ? std::clamp(answer, -steepest_answer, steepest_answer) : 0;
}

Tensor3 next(const Path& path, const Point& at, double lateral, double size) {
  Tensor3 F = at.F;
  if (path.kind == "shear") {
    F[2] += size;
  } else if (path.kind == "isochoric") {
    F[8] -= size;
    F[0] = F[4] = 1 / std::sqrt(F[8]);
  } else {
    const double answer = lateral_answer(at, lateral, size);
    const double scale = size / std::max(std::abs(answer), 1.0);
    F[0] += answer * scale;
    F[4] += answer * scale;
    F[8] -= scale;
  }
  return F;
}

}  // namespace

Material make_spheres(int count, long seed, double tolerance, double stiffness, double friction) {
  return Material::parse(
      fmt::format("dimension = 3\n[packing]\ngenerator = \"compaction\"\ncount = {}\n"
                  "radii = [3e-3, 6e-3]\nseed = {}\npressure = {}\n[contact]\n"
                  "law = \"frictional\"\nyoung = {}\nratio = 0.8\nfriction = {}\n"
                  "[solver]\ntolerance = {}\n",
                  count, seed, start_pressure,
                  2 * stiffness * start_pressure,  // kn = E R, and d = 2 R
                  friction, tolerance),
      ".");
}

void lead_spheres(Path& path, const Material& material, const SmallIncrements& limits,
                  const Observer& observe) {
  State state(material);
  Point at;
  const auto solve = [&](const Tensor3& F, Point& to) {
    to.F = F;
    return state.evaluate(F, to.P, GRAINLAW_WANT_TANGENT_EXACT, to.A);
  };
  solve(at.F, at);
  state.revert();
  const double first = pressure(at.P, at.F);
  const double lateral = 0.5 * (at.P[0] + at.P[4]);
  for (int step = 1; step <= limits.steps(path.stiffness); ++step) {
    path.pressure = pressure(at.P, at.F) / first;
    if (path.pressure < least_pressure) {
      path.gave_up =
          fmt::format("the pressure has fallen to {:.2g} of that at the start", path.pressure);
      return;
    }
    Point to;
    const double size = limits.size(path.stiffness / path.pressure);
    const double start = cpu_milliseconds();
    const auto result = solve(next(path, at, lateral, size), to);
    Increment increment;
    increment.step = step;
    increment.strain = path.kind == "shear" ? to.F[2] : 1 - to.F[8];
    increment.hardness = size * path.stiffness / path.pressure;
    increment.ending = ending(result);
    increment.status = result.status;
    increment.report = result.report;
    increment.cpu = cpu_milliseconds() - start;
    path.increments.push_back(increment);
    observe(increment);
    if (result.status != GRAINLAW_OK) {
      path.gave_up = grainlaw_status_text(result.status);
      return;
    }
    state.commit();
    at = to;
  }
}

}  // namespace verification::reach

#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

namespace verification::drag {
namespace {

constexpr double end = 0.015;   // strain
constexpr double usual = 1e-3;  // step of equilibrium
constexpr std::array steps{5e-4, 1e-3, 2e-3};
constexpr double coarse = 5e-3;  // told, without a bound

// Largest bias of q / p [%], by friction.
double bound_of(int dimension, double friction) {
  if (dimension == 3) return 1;
  if (friction < 0.15) return 3.3;
  return friction > 0.6 ? 2.2 : 1.2;
}

// q, p at multiples of the step, from the first on; empty after one that failed.
struct Path {
  std::vector<std::optional<std::array<double, 2>>> at;
  double unbalanced = 0, relaxation_steps = 0, milliseconds = 0;  // means
  int failed = 0;
};

template <int D>
Path run(const Material& material, double step) {
  Host<D> host(material);
  Path path;
  const int count = static_cast<int>(std::floor(end / step + 1e-9));
  for (int k = 1; k <= count; ++k) {
    path.at.emplace_back();
    if (path.failed == 0 && host.lead(isochoric<D>(k * step)))
      path.at.back() = {host.q(), host.p()};
    else
      ++path.failed;
  }
  path.unbalanced = average(host.unbalanced);
  path.relaxation_steps = host.relaxation_steps / host.evaluations;
  path.milliseconds = host.milliseconds / host.evaluations;
  return path;
}

// Biases of one path at places that it and equilibrium share [%].
struct Bias {
  double ratio = 0, q = 0, p = 0;
};

Bias bias_of(const Path& path, double step, const Path& rest) {
  double ratio = 0, ratio_size = 0, q = 0, q_size = 0, p = 0, p_size = 0;
  for (std::size_t k = 0; k < path.at.size(); ++k) {
    const double level = step * static_cast<double>(k + 1) / usual;
    const double nearest = std::round(level);
    if (std::abs(level - nearest) > 1e-6 || nearest > static_cast<double>(rest.at.size())) continue;
    const auto& own = path.at[k];
    const auto& other = rest.at[static_cast<std::size_t>(nearest) - 1];
    if (!own || !other) continue;
    ratio += (*own)[0] / (*own)[1] - (*other)[0] / (*other)[1];
    ratio_size += (*other)[0] / (*other)[1];
    q += (*own)[0] - (*other)[0];
    q_size += (*other)[0];
    p += (*own)[1] - (*other)[1];
    p_size += (*other)[1];
  }
  return {100 * ratio / ratio_size, 100 * q / q_size, 100 * p / p_size};
}

template <int D>
void cell(Study& study, Findings& findings, double stiffness, double friction, int seeds,
          int count) {
  std::vector<Path> rest;
  std::vector<Packing> packings = D == 2 ? discs(seeds, count) : spheres(seeds, count);
  for (Packing& packing : packings) {
    packing.young = young_of(D, stiffness);
    packing.friction = friction;
    rest.push_back(run<D>(study.materials(packing, equilibrium), usual));
  }
  for (const double step : {steps[0], steps[1], steps[2], coarse}) {
    std::vector<double> ratio, q, p, unbalanced, relaxation, ms, rest_relaxation, rest_ms;
    double failed = 0, rest_failed = 0;
    for (std::size_t k = 0; k < packings.size(); ++k) {
      const Path path = run<D>(study.materials(packings[k], {}), step);
      const Bias bias = bias_of(path, step, rest[k]);
      ratio.push_back(bias.ratio);
      q.push_back(bias.q);
      p.push_back(bias.p);
      unbalanced.push_back(100 * path.unbalanced);
      relaxation.push_back(path.relaxation_steps);
      ms.push_back(path.milliseconds);
      rest_relaxation.push_back(rest[k].relaxation_steps);
      rest_ms.push_back(rest[k].milliseconds);
      failed += path.failed;
      rest_failed += rest[k].failed;
    }
    const bool is_told = step == coarse || friction == 0;
    findings.row(
        {fmt::format("{} {}, kn/p {:g}", packings.size(), D == 2 ? "discs" : "spheres", stiffness),
         fmt::format("friction {:g}, step {:g} %", friction, 100 * step), average(ratio),
         standard_error(ratio), average(q), average(p), average(unbalanced), average(relaxation),
         average(rest_relaxation), average(ms), average(rest_ms), failed, rest_failed},
        {{std::abs(average(ratio)), is_told ? told : bound_of(D, friction)}});
  }
}

}  // namespace

void measure_bias(Study& study) {
  Findings findings(
      study.options(), "bias",
      "isochoric to 1.5 %, against equilibrium in steps of 0.1 %: bias of q / p, q and p, mean of "
      "the packings; kn/p stands for kn / (p t) of discs, kn / (p R) of spheres",
      {"packings", "case", "ratio[%]", "s.e.[%]", "q[%]", "p[%]", "unbalanced[%]",
       "relaxation_steps[-]", "equilibrium_steps[-]", "ms[-]", "equilibrium_ms[-]", "failed[-]",
       "equilibrium_failed[-]"},
      {{"bias[%]"}});
  for (const double stiffness : {300.0, 3e3, 3e4}) {
    for (const double friction : {0.1, 0.2, 0.5, 0.8})
      cell<2>(study, findings, stiffness, friction, study.packings(3), 200);
  }
  cell<2>(study, findings, 300, 0, study.packings(3), 200);
  for (const double stiffness : {1e3, 1e4}) {
    for (const double friction : {0.2, 0.5})
      cell<3>(study, findings, stiffness, friction, study.packings(2), 150);
  }
  findings.print();
}

}  // namespace verification::drag

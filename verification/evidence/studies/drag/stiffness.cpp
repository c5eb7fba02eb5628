#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace verification::drag {
namespace {

constexpr std::array reversals{1e-6, 1e-5, 1e-4, 2.5e-4, 5e-4};  // strain
constexpr double largest_apart = 3;                              // of a secant [%]

// Steps on the way to the reversal, in parts of 0.1 %, again and again.
struct Approach {
  const char* name;
  std::vector<double> parts;
};
const std::vector<Approach>& approaches() {
  static const std::vector<Approach> list{{"0.1 %", {1}},
                                          {"0.025 %", {0.25, 0.25, 0.25, 0.25}},
                                          {"0.01 and 0.09 %", {0.1, 0.9}},
                                          {"0.09 and 0.01 %", {0.9, 0.1}}};
  return list;
}

constexpr std::array ends{0.005, 0.01, 0.015};  // strain

template <int D>
Host<D> lead_to(const Material& material, const std::vector<double>& parts, double end) {
  constexpr double step = 1e-3;
  Host<D> host(material);
  for (int k = 0; k < static_cast<int>(std::lround(end / step)); ++k) {
    double done = 0;
    for (const double part : parts) {
      done += part;
      host.lead(isochoric<D>(step * (k + done)), part);
    }
  }
  return host;
}

// The secant of q on the way back, which lasts its share of 0.1 % [Pa].
template <int D>
double secant(const Host<D>& from, const TensorOf<D>& to, double strain) {
  Host<D> host(from);
  if (!host.lead(to, strain / 1e-3, 0)) return told;
  return (from.q() - host.q()) / strain;
}

// Over those of equilibrium, for each reversal: from the end of its own path, and from the packing
// that the law is at.
using Ratios = std::array<double, reversals.size()>;
struct Reversal {
  Ratios own, same;
  double unbalanced;  // at the turn [%]
};

template <int D>
Reversal reverse(Study& study, const Packing& packing, const Host<D>& law, const Host<D>& rest,
                 double end) {
  const Host<D> same(study.materials.at_rest(law.state, packing));
  const TensorOf<D> origin = law.deformation.inverse();
  Reversal result{{}, {}, 100 * law.report.unbalanced};
  for (std::size_t k = 0; k < reversals.size(); ++k) {
    const TensorOf<D> back = isochoric<D>(end - reversals[k]);
    const double own = secant<D>(law, back, reversals[k]);
    result.own[k] = own / secant<D>(rest, back, reversals[k]);
    result.same[k] = own / secant<D>(same, back * origin, reversals[k]);
  }
  return result;
}

void add_row(Findings& findings, const std::string& packing, const std::string& steps,
             const char* other, const Ratios& ratios, double unbalanced) {
  std::vector<Table::Cell> facts{packing, steps, other, unbalanced};
  std::vector<double> apart;
  for (const double ratio : ratios) {
    facts.emplace_back(ratio);
    apart.push_back(100 * std::abs(ratio - 1));
  }
  findings.row(facts, {{largest(apart), largest_apart}});
}

Ratios mean_of(const std::vector<Reversal>& all, Ratios Reversal::*which) {
  Ratios mean{};
  for (const Reversal& one : all)
    for (std::size_t k = 0; k < mean.size(); ++k)
      mean[k] += (one.*which)[k] / static_cast<double>(all.size());
  return mean;
}

void reverse_all(Study& study) {
  std::vector<std::string> facts{"packing", "steps", "equilibrium_of", "unbalanced[%]"};
  for (const double strain : reversals) facts.push_back(fmt::format("{:g}[-]", strain));
  Findings findings(study.options(), "reversal",
                    "secant stiffness after a reversal of isochoric strain over that of "
                    "equilibrium, from the end of its own path or from the packing that the law is "
                    "at; unbalanced force at the turn",
                    facts, {{"apart[%]"}});
  for (const std::vector<Packing>& packings :
       {discs(study.packings(3)), spheres(study.packings(2))}) {
    for (const Approach& approach : approaches()) {
      std::vector<Reversal> all;
      for (const Packing& packing : packings) {
        for (const double end : ends) {
          all.push_back(in_dimension(packing.dimension, [&](auto d) {
            const auto law = lead_to<d>(study.materials(packing, {}), approach.parts, end);
            const auto rest = lead_to<d>(study.materials(packing, equilibrium), {1}, end);
            return reverse<d>(study, packing, law, rest, end);
          }));
          const std::string name = fmt::format("{}, at {:g} %", packing.name(), 100 * end);
          add_row(findings, name, approach.name, "its path", all.back().own, all.back().unbalanced);
          add_row(findings, name, approach.name, "this packing", all.back().same,
                  all.back().unbalanced);
        }
      }
      std::vector<double> unbalanced;
      for (const Reversal& one : all) unbalanced.push_back(one.unbalanced);
      const std::string name = fmt::format("mean of {} {}", all.size(),
                                           packings[0].dimension == 2 ? "discs" : "spheres");
      add_row(findings, name, approach.name, "its path", mean_of(all, &Reversal::own),
              average(unbalanced));
      add_row(findings, name, approach.name, "this packing", mean_of(all, &Reversal::same),
              average(unbalanced));
    }
  }
  findings.print();
}

// A cycle between strains + and - amplitude, after the first loading.
struct Cycle {
  double stiffness = 0;  // shear modulus, secant from end to end [Pa]
  double work = 0;       // area of the loop [Pa]
  double damping = 0;    // work / (4 pi x energy of the secant) [-]
};

// The mean of the loop from + to + and that from - to -, so that a stress that drifts cancels.
template <int D>
Cycle cycle(const Material& material, double amplitude) {
  constexpr int fewest = 8;
  constexpr double longest = 1e-3;
  const int quarter = std::max(fewest, static_cast<int>(std::lround(amplitude / longest)));
  const double step = amplitude / quarter;
  Host<D> host(material);
  Cycle result;
  double last = 0, before = host.q(), top = 0, bottom = 0;
  for (int k = 1; k <= 7 * quarter; ++k) {
    // 0 -> 1 -> -1 -> 1 -> -1
    const int way = std::abs((k + quarter) % (4 * quarter) - 2 * quarter);
    const double strain = step * (quarter - way);
    if (!host.lead(isochoric<D>(strain), step / longest)) return {told, told, told};
    const double work = 0.5 * (before + host.q()) * (strain - last);
    if (k > quarter && k <= 5 * quarter) result.work += 0.5 * work;
    if (k > 3 * quarter) result.work += 0.5 * work;
    if (k == 3 * quarter) bottom = host.q();
    if (k == 5 * quarter) top = host.q();
    last = strain;
    before = host.q();
  }
  // q = 4 G e of discs, 3 G e of spheres.
  result.stiffness = (top - bottom) / (2 * amplitude) / (D == 2 ? 4 : 3);
  result.damping = result.work / (std::numbers::pi * (top - bottom) * amplitude);
  return result;
}

void cycle_all(Study& study) {
  Findings findings(
      study.options(), "cycles",
      "isochoric cycles about F = I: secant shear modulus, damping and work after the first "
      "loading; eight steps a quarter, at most 0.1 % each",
      {"packing", "amplitude", "modulus_over_p[-]", "equilibrium[-]", "damping[-]",
       "equilibrium_damping[-]", "work_over_equilibrium[-]"},
      {{"modulus_apart[%]"}});
  constexpr double smallest_told = 2e-3;  // beyond, packings rearrange in each other way
  std::vector<Packing> packings = discs(study.packings(2));
  for (const Packing& packing : spheres(study.packings(1))) packings.push_back(packing);
  for (const Packing& packing : packings) {
    in_dimension(packing.dimension, [&](auto d) {
      for (const double amplitude : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
        const Cycle rest = cycle<d>(study.materials(packing, equilibrium), amplitude);
        const Cycle law = cycle<d>(study.materials(packing, {}), amplitude);
        findings.row({packing.name(), fmt::format("{:g}", amplitude), law.stiffness / pressure,
                      rest.stiffness / pressure, law.damping, rest.damping, law.work / rest.work},
                     {{100 * std::abs(law.stiffness / rest.stiffness - 1),
                       amplitude < smallest_told ? largest_apart : told}});
      }
    });
  }
  findings.print();
}

}  // namespace

void measure_stiffness(Study& study) {
  reverse_all(study);
  cycle_all(study);
}

}  // namespace verification::drag

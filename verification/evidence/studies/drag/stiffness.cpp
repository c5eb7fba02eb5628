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

constexpr double turning_point = 0.01;

template <int D>
Host<D> lead_to_turn(const Material& material, const std::vector<double>& parts) {
  constexpr double step = 1e-3;
  Host<D> host(material);
  for (int k = 0; k < static_cast<int>(std::lround(turning_point / step)); ++k) {
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

template <int D>
void reverse(Study& study, Findings& findings, const Packing& packing) {
  const Host<D> rest = lead_to_turn<D>(study.materials(packing, equilibrium), {1});
  for (const Approach& approach : approaches()) {
    const Host<D> law = lead_to_turn<D>(study.materials(packing, {}), approach.parts);
    const Host<D> same(study.materials.at_rest(law.state, packing));
    const auto compare = [&](const char* name, const Host<D>& other, const TensorOf<D>& origin) {
      std::vector<Table::Cell> facts{packing.name(), approach.name, name};
      std::vector<double> apart;
      for (const double strain : reversals) {
        const TensorOf<D> back = isochoric<D>(turning_point - strain);
        const TensorOf<D> there = back * origin.inverse();
        const double ratio = secant<D>(law, back, strain) / secant<D>(other, there, strain);
        facts.emplace_back(ratio);
        apart.push_back(100 * std::abs(ratio - 1));
      }
      findings.row(facts, {{largest(apart), largest_apart}});
    };
    compare("its own path", rest, TensorOf<D>::Identity());
    compare("this packing", same, law.deformation);
  }
}

void reverse_all(Study& study) {
  std::vector<std::string> facts{"packing", "steps", "equilibrium_of"};
  for (const double strain : reversals) facts.push_back(fmt::format("{:g}[-]", strain));
  Findings findings(study.options(), "reversal",
                    "secant stiffness after a reversal at 1 % of isochoric strain over that of "
                    "equilibrium, from its own path or from the packing that the law has there",
                    facts, {{"apart[%]"}});
  std::vector<Packing> packings = discs(study.packings(3));
  for (const Packing& packing : spheres(study.packings(2))) packings.push_back(packing);
  for (const Packing& packing : packings)
    in_dimension(packing.dimension, [&](auto d) { reverse<d>(study, findings, packing); });
  findings.print();
}

// The second cycle between strains + and - amplitude.
struct Cycle {
  double stiffness = 0;  // shear modulus, secant from end to end [Pa]
  double work = 0;       // area of the loop [Pa]
  double damping = 0;    // work / (4 pi x energy of the secant) [-]
};

template <int D>
Cycle cycle(const Material& material, double amplitude) {
  constexpr int fewest = 8;
  constexpr double longest = 1e-3;
  const int quarter = std::max(fewest, static_cast<int>(std::lround(amplitude / longest)));
  Host<D> host(material);
  Cycle result;
  double last = 0, before = host.q(), above = 0;
  const double step = amplitude / quarter;
  // 0 -> 1 -> -1 -> 1: the last two parts are the cycle.
  for (int k = 1; k <= 5 * quarter; ++k) {
    const int place = k <= quarter ? k : k <= 3 * quarter ? 2 * quarter - k : k - 4 * quarter;
    const double strain = step * place;
    if (!host.lead(isochoric<D>(strain), step / longest)) return {told, told, told};
    if (k > quarter) result.work += 0.5 * (before + host.q()) * (strain - last);
    if (k == 3 * quarter) above = -host.q();
    last = strain;
    before = host.q();
  }
  above += host.q();
  // q = 4 G e of discs, 3 G e of spheres.
  result.stiffness = above / (2 * amplitude) / (D == 2 ? 4 : 3);
  result.damping = result.work / (4 * std::numbers::pi * 0.25 * above * amplitude);
  return result;
}

void cycle_all(Study& study) {
  Findings findings(
      study.options(), "cycles",
      "isochoric cycles about F = I: shear modulus and damping of the second half and first "
      "return; eight steps a quarter, at most 0.1 % each",
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

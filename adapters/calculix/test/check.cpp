// Compares what CalculiX asked and got (record.c) with the library itself, of discs or spheres.
//
//   grainlaw_calculix_check patch|cut|newton MATERIAL.toml RECORD.csv PATH.csv
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference.hpp"

namespace {

using namespace grainlaw::test;
// Components of F that a packing of this dimension has, by rows.
template <std::size_t d>
using Gradient = std::array<double, d * d>;

struct Call {
  int command = 0, elastic = 0;
  double time = 0, pnewdt = 0;
  std::array<double, 9> columns{};  // of F
  std::array<double, 6> stress{};
  std::array<double, 21> stiffness{};

  template <std::size_t d>
  [[nodiscard]] Gradient<d> F() const {
    Gradient<d> rows;
    for (std::size_t c = 0; c < d * d; ++c) rows[c] = columns[c % d * 3 + c / d];
    return rows;
  }
};

std::vector<std::vector<double>> read_numbers(const std::string& path, int header) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (header-- > 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double value; numbers >> value;) rows.back().push_back(value);
  }
  if (rows.empty()) throw std::runtime_error(path + " is empty");
  return rows;
}

std::vector<Call> read_calls(const std::string& path) {
  std::vector<Call> calls;
  for (const auto& row : read_numbers(path, 0)) {
    if (row.size() != 40) throw std::runtime_error("a line of the record has not 40 numbers");
    Call call;
    call.command = static_cast<int>(row[0]);
    call.elastic = static_cast<int>(row[1]);
    call.time = row[2];
    call.pnewdt = row[3];
    std::copy_n(&row[4], 9, call.columns.begin());
    std::copy_n(&row[13], 6, call.stress.begin());
    std::copy_n(&row[19], 21, call.stiffness.begin());
    calls.push_back(call);
  }
  return calls;
}

// The last full call before each accepted increment's last word.
std::vector<Call> accepted(const std::vector<Call>& calls) {
  std::vector<Call> result;
  for (std::size_t k = 1; k < calls.size(); ++k) {
    if (calls[k].command == 3) result.push_back(calls[k - 1]);
  }
  return result;
}

template <std::size_t d>
bool patch(grainlaw::State state, const std::vector<Call>& calls, const std::string& path) {
  const auto rows = read_numbers(path, 1);
  state.set_time_step(1);  // each is a step of CalculiX
  const auto steps = accepted(calls);
  bool good = steps.size() == rows.size();
  for (std::size_t k = 0; k < steps.size() && k < rows.size(); ++k) {
    const Gradient<d> F = steps[k].F<d>();
    double off = 0;
    for (std::size_t c = 0; c < d * d; ++c) off = std::max(off, std::abs(F[c] - rows[k].at(c)));
    const Reference expected = reference(state, F, true);
    const auto [stress, stiffness] =
        distance(expected, steps[k].stress.data(), steps[k].stiffness.data());
    std::printf("step %zu: F off by %.1e, S by %.1e, symmetric dS/dE by %.1e (skew part %.1e)\n",
                k + 1, off, stress, stiffness, expected.skew);
    good = good && off <= 1e-14 && stress <= 1e-12 && stiffness <= 1e-12;
  }
  return good;
}

// The increments that CalculiX accepted, uncut: discs sheared by 0.8, spheres shortened by 0.4.
template <std::size_t d>
bool cut(grainlaw::State state, const std::vector<Call>& calls) {
  const auto refused = std::count_if(calls.begin(), calls.end(), [](const Call& call) {
    return call.pnewdt > 0 && call.pnewdt < 1;
  });
  const auto steps = accepted(calls);
  double worst = 0, before = 0;
  for (const Call& step : steps) {
    state.set_time_step(step.time - before);
    before = step.time;
    const Reference expected = reference(state, step.F<d>(), true);
    worst = std::max(worst, distance(expected, step.stress.data(), step.stiffness.data())[0]);
  }
  const double led = d == 2 ? steps.back().columns[3] : 1 - steps.back().columns[8];
  std::printf("%ld calls refused, %zu increments to %g; S off by %.1e\n",
              static_cast<long>(refused), steps.size(), led, worst);
  return refused > 0 && std::abs(led - (d == 2 ? 0.8 : 0.4)) < 1e-12 && worst <= 1e-12;
}

// Drained compression of the packing alone along its last axis: the other stretches, by Newton's
// method, such that the Cauchy stress along them is -100 kPa. Its axial stresses have to be those of
// CalculiX.
template <std::size_t d>
bool newton(grainlaw::State state, const std::vector<Call>& calls) {
  constexpr double pressure = 1e5;
  constexpr std::size_t last = d * d - 1;
  bool good = true;
  Gradient<d> F{}, P{};
  for (std::size_t i = 0; i < d; ++i) F[i * (d + 1)] = 1;
  std::array<double, d * d * d * d> A{};
  double before = 0;
  for (const Call& step : accepted(calls)) {
    F[last] = step.F<d>()[last];
    state.set_time_step(step.time - before);
    before = step.time;
    for (int iteration = 0; iteration < 30; ++iteration) {
      if (!state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A)) return false;
      // P11 = -p F22, in space P11 = -p F22 F33 and P22 = -p F11 F33.
      const double across = d == 2 ? F[last] : F[last] * F[4];
      const double r1 = P[0] + pressure * across;
      if constexpr (d == 2) {
        if (std::abs(r1) < 1e-4) break;
        F[0] -= r1 / A[0];
      } else {
        const double r2 = P[4] + pressure * F[last] * F[0];
        if (std::hypot(r1, r2) < 1e-4) break;
        const double a = A[0], b = A[4] + pressure * F[last], c = A[36] + pressure * F[last],
                     e = A[40];
        F[0] -= (e * r1 - b * r2) / (a * e - b * c);
        F[4] -= (a * r2 - c * r1) / (a * e - b * c);
      }
    }
    state.commit();
    double section = 1, section_found = 1;
    for (std::size_t i = 0; i + 1 < d; ++i) {
      section *= F[i * (d + 1)];
      section_found *= step.F<d>()[i * (d + 1)];
    }
    const double axial = P[last] / section;
    const double found = step.stress[d - 1] * F[last] / section_found;  // F33 S33 / (F11 F22)
    std::printf("axial strain %.2f %%: axial stress %.4f kPa, in CalculiX %.4f kPa (%.1e)\n",
                100 * (1 - F[last]), -axial / 1e3, -found / 1e3, std::abs(found / axial - 1));
    good = good && std::abs(found / axial - 1) <= 1e-6;
  }
  const auto iterations =
      std::count_if(calls.begin(), calls.end(), [](const Call& call) { return call.command != 3; });
  std::printf("%ld calls with a tangent in %zu increments\n", static_cast<long>(iterations),
              accepted(calls).size());
  return good && accepted(calls).size() == 5;
}

template <std::size_t d>
bool check(const std::string& what, const grainlaw::Material& material,
           const std::vector<Call>& calls, const std::string& path) {
  grainlaw::State state(material);
  return what == "patch" ? patch<d>(std::move(state), calls, path)
         : what == "cut" ? cut<d>(std::move(state), calls)
                         : newton<d>(std::move(state), calls);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: grainlaw_calculix_check patch|cut|newton MATERIAL RECORD PATH\n");
    return 2;
  }
  try {
    const auto material = grainlaw::Material::load(arguments[2]);
    const bool good =
        (material.dimension() == 2 ? check<2> : check<3>)(arguments[1], material,
                                                          read_calls(arguments[3]), arguments[4]);
    return good ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// Compares what CalculiX asked and got (record.c) with the library itself.
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
using F2 = std::array<double, 4>;

struct Call {
  int command = 0, elastic = 0;
  double time = 0, pnewdt = 0;
  F2 F{};
  std::array<double, 6> stress{};
  std::array<double, 21> stiffness{};
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
    call.F = {row[4], row[7], row[5], row[8]};
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

bool patch(grainlaw::State state, const std::vector<Call>& calls, const std::string& path) {
  const auto rows = read_numbers(path, 1);
  state.set_time_step(1);  // each is a step of CalculiX
  const auto steps = accepted(calls);
  bool good = steps.size() == rows.size();
  for (std::size_t k = 0; k < steps.size() && k < rows.size(); ++k) {
    double off = 0;
    for (std::size_t c = 0; c < 4; ++c) off = std::max(off, std::abs(steps[k].F[c] - rows[k][c]));
    const Reference expected = reference(state, steps[k].F, true);
    const auto [stress, stiffness] =
        distance(expected, steps[k].stress.data(), steps[k].stiffness.data());
    std::printf("step %zu: F off by %.1e, S by %.1e, symmetric dS/dE by %.1e (skew part %.1e)\n",
                k + 1, off, stress, stiffness, expected.skew);
    good = good && off <= 1e-14 && stress <= 1e-12 && stiffness <= 1e-12;
  }
  return good;
}

// The increments that CalculiX accepted, uncut.
bool cut(grainlaw::State state, const std::vector<Call>& calls) {
  const auto refused = std::count_if(calls.begin(), calls.end(), [](const Call& call) {
    return call.pnewdt > 0 && call.pnewdt < 1;
  });
  const auto steps = accepted(calls);
  double worst = 0;
  for (const Call& step : steps) {
    const Reference expected = reference(state, step.F, true);
    worst = std::max(worst, distance(expected, step.stress.data(), step.stiffness.data())[0]);
  }
  std::printf("%ld calls refused, %zu increments to F12 = %g; S off by %.1e\n",
              static_cast<long>(refused), steps.size(), steps.back().F[1], worst);
  return refused > 0 && std::abs(steps.back().F[1] - 0.8) < 1e-12 && worst <= 1e-12;
}

// Drained compression of the packing alone: F11, by Newton's method, such that the Cauchy stress
// along 1 is -100 kPa. Its axial stresses have to be those of CalculiX.
bool newton(grainlaw::State state, const std::vector<Call>& calls) {
  bool good = true;
  double before = 1;
  for (const Call& step : accepted(calls)) {
    F2 F{before, 0, 0, step.F[3]}, P{};
    std::array<double, 16> A{};
    for (int iteration = 0; iteration < 20; ++iteration) {
      if (!state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A)) return false;
      const double residual = P[0] + 1e5 * F[3];  // P11 = -p F22
      if (std::abs(residual) < 1e-4) break;
      F[0] -= residual / A[0];
    }
    state.commit();
    before = F[0];
    const double axial = P[3] / F[0];
    const double found = step.stress[1] * step.F[3] / step.F[0];  // F22 S22 / F11
    std::printf("axial strain %.2f %%: axial stress %.4f kPa, in CalculiX %.4f kPa (%.1e)\n",
                100 * (1 - F[3]), -axial / 1e3, -found / 1e3, std::abs(found / axial - 1));
    good = good && std::abs(found / axial - 1) <= 1e-6;
  }
  const auto iterations =
      std::count_if(calls.begin(), calls.end(), [](const Call& call) { return call.command != 3; });
  std::printf("%ld calls with a tangent in %zu increments\n", static_cast<long>(iterations),
              accepted(calls).size());
  return good && accepted(calls).size() == 5;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: grainlaw_calculix_check patch|cut|newton MATERIAL RECORD PATH\n");
    return 2;
  }
  try {
    const std::string what = arguments[1];
    grainlaw::State state(grainlaw::Material::load(arguments[2]));
    const auto calls = read_calls(arguments[3]);
    const bool good = what == "patch" ? patch(std::move(state), calls, arguments[4])
                      : what == "cut" ? cut(std::move(state), calls)
                                      : newton(std::move(state), calls);
    return good ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

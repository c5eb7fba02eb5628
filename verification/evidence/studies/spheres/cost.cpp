#include "evidence/studies/spheres/spheres.hpp"

#include "evidence/studies/features/cost.hpp"
#include "evidence/studies/statistics.hpp"

#include "app/cpu_time.hpp"
#include "app/progress.hpp"
#include "app/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace verification::spheres {
namespace {

struct Cost {
  std::vector<double> plain, exact;  // [ms]
  std::vector<double> steps, factorisations;
  int failed = 0;
  double state = 0;  // committed and trial [B]
};

// At the end of a path: committed there, with a trial beside. The thread has all it needs.
double state_bytes(const grainlaw::Material& material, const Tensor3& end, const Tensor3& beyond) {
  const double before = heap_bytes();
  grainlaw::State state(material);
  Tensor3 P{};
  if (state.evaluate(end, P).status == GRAINLAW_OK) state.commit();
  static_cast<void>(state.evaluate(beyond, P));
  return heap_bytes() - before;
}

// Triaxial compression in steps of 0.1 %.
Cost cost_of(const grainlaw::Material& material, int increments) {
  grainlaw::State state(material);
  Cost cost;
  Tensor3 P{};
  Tangent3 A{};
  for (int k = 1; k <= increments; ++k) {
    const Tensor3 F = deformation_after(k);
    const double start = cpu_seconds();
    const auto plain = state.evaluate(F, P);
    const double between = cpu_seconds();
    const auto exact = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A);
    const double end = cpu_seconds();
    if (plain.status != GRAINLAW_OK || exact.status != GRAINLAW_OK) {
      ++cost.failed;
      if (exact.status != GRAINLAW_OK) break;
    }
    constexpr double ms = 1e3;
    cost.plain.push_back(ms * (between - start));
    cost.exact.push_back(ms * (end - between));
    cost.steps.push_back(static_cast<double>(plain.report.relaxation_steps));
    cost.factorisations.push_back(plain.report.factorisations);
    state.commit();
  }
  cost.state = state_bytes(material, deformation_after(1), deformation_after(2));
  return cost;
}

}  // namespace

void measure_cost(const StudyOptions& options, const std::vector<int>& counts, int increments) {
  struct Setting {
    double viscous_number, tolerance;
    double plain = 0, exact = 0;  // of the fewest spheres [ms]
  };
  std::array<Setting, 3> settings{{{0, 1e-3}, {0, 1e-8}, {1e-3, 1e-8}}};
  Table table(fmt::format("one evaluation of a 0.1 % increment, the first {} of triaxial "
                          "compression, one thread; powers: of the number, against the fewest",
                          increments),
              {"spheres", "viscous_number[-]", "tolerance[-]", "cpu[ms]", "power[-]",
               "cpu_with_tangent[ms]", "power_with_tangent[-]", "relaxation_steps[-]",
               "newton_steps[-]", "failed[-]", "state[B/sphere]"});
  Progress progress("spheres");
  double done = 0;
  for (const int count : counts) {
    const double more = static_cast<double>(count) / counts[0];
    const auto power = [&](double time, double least) {
      return count == counts[0] ? 0 : std::log(time / least) / std::log(more);
    };
    for (Setting& setting : settings) {
      progress.update(done++ / static_cast<double>(settings.size() * counts.size()),
                      fmt::format("{} spheres", count));
      const Cost cost =
          cost_of(packed(count, setting.viscous_number, setting.tolerance), increments);
      const double plain = average(cost.plain), exact = average(cost.exact);
      if (count == counts[0]) setting.plain = plain, setting.exact = exact;
      table.row({fmt::format("{}", count), fmt::format("{:g}", setting.viscous_number),
                 fmt::format("{:g}", setting.tolerance), plain, power(plain, setting.plain), exact,
                 power(exact, setting.exact), average(cost.steps), average(cost.factorisations),
                 static_cast<double>(cost.failed), cost.state / count});
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres.csv");
  table.print();
}

}  // namespace verification::spheres

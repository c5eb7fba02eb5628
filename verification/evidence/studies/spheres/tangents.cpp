#include "evidence/studies/spheres/spheres.hpp"

#include "evidence/studies/statistics.hpp"

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

// Of the exact tangent against central differences, the best of several steps; NaN where one fails, and
// where the report says that the tangent is not exact.
double tangent_error(grainlaw::State& state, const Tensor3& F) {
  Tensor3 P{};
  Tangent3 A{};
  const auto found = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A);
  if (found.status != GRAINLAW_OK || found.report.tangent_exact == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    double error = 0;
    double size = 0;
    for (std::size_t k = 0; k < F.size(); ++k) {
      Tensor3 above{}, below{};
      for (const double sign : {1.0, -1.0}) {
        Tensor3 moved = F;
        moved[k] += sign * step;
        if (state.evaluate(moved, sign > 0 ? above : below).status != GRAINLAW_OK) {
          return std::numeric_limits<double>::quiet_NaN();
        }
      }
      for (std::size_t m = 0; m < F.size(); ++m) {
        const double difference = (above[m] - below[m]) / (2 * step);
        error += std::pow(A[F.size() * m + k] - difference, 2);
        size += std::pow(difference, 2);
      }
    }
    least = std::min(least, std::sqrt(error / size));
  }
  return least;
}

struct TangentErrors {
  std::vector<double> of_exact;
  int states = 0;
};

TangentErrors tangent_errors(const grainlaw::Material& material, bool shear, int increments) {
  grainlaw::State state(material);
  TangentErrors errors;
  for (int k = 1; k <= increments; ++k) {
    const Tensor3 F = deformation_after(k, shear);
    const double error = tangent_error(state, F);
    if (std::isfinite(error)) errors.of_exact.push_back(error);
    ++errors.states;
    Tensor3 P{};
    if (state.evaluate(F, P).status != GRAINLAW_OK) break;
    state.commit();
  }
  return errors;
}

}  // namespace

void check_tangents(const StudyOptions& options, int increments) {
  Table table(fmt::format("exact tangent against central differences after each of {} increments, "
                          "tolerance 1e-11 [-], the best of three steps",
                          increments),
              {"spheres", "viscous_time[-]", "path", "median[-]", "largest[-]", "above_1e-6[-]",
               "not_exact[-]"});
  for (const int count : {60, 200, 500}) {
    for (const double time : {0.0, 100.0}) {
      const auto material = packed(count, time, 1e-11);
      for (const bool shear : {false, true}) {
        const auto [errors, states] = tangent_errors(material, shear, increments);
        const double largest = errors.empty() ? 0 : *std::ranges::max_element(errors);
        const auto above = std::ranges::count_if(errors, [](double error) { return error > 1e-6; });
        table.row({fmt::format("{}", count), fmt::format("{:g}", time),
                   shear ? "shear" : "triaxial", median(errors), largest,
                   static_cast<double>(above), states - static_cast<double>(errors.size())});
      }
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres_tangent.csv");
  table.print();
}

}  // namespace verification::spheres

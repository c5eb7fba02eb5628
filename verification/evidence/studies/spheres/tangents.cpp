#include "evidence/studies/spheres/spheres.hpp"

#include "evidence/studies/statistics.hpp"

#include "app/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace verification::spheres {
namespace {

struct TangentError {
  double relative = 0;  // Frobenius norm, of the best stencil [-]
  // Every stencil has a point with other contacts than the centre, or one that fails.
  bool changed = false;
};

struct TangentErrors {
  std::vector<double> of_smooth, of_changed;
  int not_exact = 0;
};

// Error of A against central differences with this step; nothing where a point fails.
std::optional<TangentError> error_of_step(grainlaw::State& state, const Tensor3& F,
                                          const Tangent3& A, const grainlaw_report& centre,
                                          double step) {
  double error = 0;
  double size = 0;
  bool changed = false;
  for (std::size_t k = 0; k < F.size(); ++k) {
    Tensor3 above{}, below{};
    for (const double sign : {1.0, -1.0}) {
      Tensor3 moved = F;
      moved[k] += sign * step;
      const auto there = state.evaluate(moved, sign > 0 ? above : below);
      if (there.status != GRAINLAW_OK || there.report.history_advanced != 0) return std::nullopt;
      changed = changed || !same_contacts(there.report, centre);
    }
    for (std::size_t m = 0; m < F.size(); ++m) {
      const double difference = (above[m] - below[m]) / (2 * step);
      error += std::pow(A[F.size() * m + k] - difference, 2);
      size += std::pow(difference, 2);
    }
  }
  return TangentError{std::sqrt(error / size), changed};
}

// A stencil without a change of status goes before one with a change; then the smallest error.
TangentError tangent_error(grainlaw::State& state, const Tensor3& F, const Tangent3& A,
                           const grainlaw_report& centre) {
  TangentError best{std::numeric_limits<double>::infinity(), true};
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    const auto next = error_of_step(state, F, A, centre, step);
    if (!next || (next->changed && !best.changed)) continue;
    if (next->changed != best.changed || next->relative < best.relative) best = *next;
  }
  return best;
}

TangentErrors tangent_errors(const grainlaw::Material& material, bool shear, int increments) {
  grainlaw::State state(material);
  TangentErrors errors;
  for (int k = 1; k <= increments; ++k) {
    const Tensor3 F = deformation_after(k, shear);
    Tensor3 P{};
    Tangent3 A{};
    const auto found = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A);
    if (found.status != GRAINLAW_OK || found.report.tangent_exact == 0) {
      ++errors.not_exact;
    } else {
      const auto centre = state.evaluate(F, P);
      const TangentError error = tangent_error(state, F, A, centre.report);
      (error.changed ? errors.of_changed : errors.of_smooth).push_back(error.relative);
    }
    if (state.evaluate(F, P).status != GRAINLAW_OK) break;
    state.commit();
  }
  return errors;
}

}  // namespace

void check_tangents(const StudyOptions& options, int increments) {
  Table table(fmt::format("exact tangent against central differences after each of {} increments, "
                          "tolerance 1e-11 [-], the best of three steps; apart, where a contact "
                          "changes its status in all three",
                          increments),
              {"spheres", "viscous_number[-]", "path", "states[-]", "median[-]", "largest[-]",
               "above_1e-6[-]", "changed[-]", "largest_of_changed[-]", "not_exact[-]"});
  for (const int count : {60, 200, 500}) {
    for (const double number : {0.0, 1e-3}) {
      const auto material = packed(count, number, 1e-11);
      for (const bool shear : {false, true}) {
        const auto errors = tangent_errors(material, shear, increments);
        const auto count_of = [](const auto& list) { return static_cast<double>(list.size()); };
        const auto above =
            std::ranges::count_if(errors.of_smooth, [](double error) { return error > 1e-6; });
        table.row({fmt::format("{}", count), fmt::format("{:g}", number),
                   shear ? "shear" : "triaxial", count_of(errors.of_smooth),
                   median(errors.of_smooth), largest(errors.of_smooth), static_cast<double>(above),
                   count_of(errors.of_changed), largest(errors.of_changed),
                   static_cast<double>(errors.not_exact)});
      }
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres_tangent.csv");
  table.print();
}

}  // namespace verification::spheres

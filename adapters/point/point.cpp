#include "point.hpp"

#include "number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace grainlaw::adapters {
namespace {

// F in the dimension of the packing.
struct Reduced {
  double F[9];

  Reduced(int dimension, const Tensor2& full) {
    for (int k = 0; k < 9; ++k) {
      const double value = full[static_cast<std::size_t>(k)];
      if (!std::isfinite(value)) {
        throw std::runtime_error(component_name(k) + " of the deformation gradient is " +
                                 shown(value) + "; a finite number was expected");
      }
    }
    if (const int wrong = reduce(dimension, full, F); wrong >= 0) {
      throw std::runtime_error(component_name(wrong) + " is " +
                               shown(full[static_cast<std::size_t>(wrong)], 9) +
                               ", but this packing of discs is plane strain in the 1-2 plane: F33 "
                               "= 1 and F13, F23, F31, "
                               "F32 = 0 were expected; hold the displacements along 3");
    }
  }
};

// F of the point where the host has not told it.
Tensor2 committed(const grainlaw::Table& table, const PointCall& call) {
  const std::vector<double> F =
      table.measure(call.element, call.point, GRAINLAW_DEFORMATION_GRADIENT);
  const auto dim = static_cast<std::size_t>(table.dimension());
  Tensor2 full = identity;
  for (std::size_t k = 0; k < F.size(); ++k) full[3 * (k / dim) + k % dim] = F[k];
  return full;
}

}  // namespace

std::string component_name(int index) {
  return {'F', static_cast<char>('1' + index / 3), static_cast<char>('1' + index % 3)};
}

double time_step_of(double told) { return std::isfinite(told) ? std::max(told, 0.0) : 0; }

Answer evaluate(grainlaw::Table& table, const PointCall& call, Response& response) {
  const int dimension = table.dimension();
  const Reduced F(dimension, call.F != nullptr ? *call.F : identity);
  const Reduced F0(dimension, call.F0 != nullptr ? *call.F0 : identity);
  double P[9], A[81];
  const auto found = table.evaluate(
      call.element, call.point,
      {call.token, call.F0 != nullptr ? F0.F : nullptr, call.F != nullptr ? F.F : nullptr,
       call.time_step, call.want, P, call.want != 0 ? A : nullptr});
  Answer answer{found.status, found.report, found.report.history_advanced != 0};
  if (!found) return answer;
  const Tensor2* const at = call.F != nullptr ? call.F : call.F0;
  response.F = at != nullptr ? *at : committed(table, call);
  complete(dimension, P, call.want != 0 ? A : nullptr, response);
  return answer;
}

Answer evaluate_symmetric(grainlaw::Table& table, const PointCall& call, Response& response) {
  const double token = call.token != nullptr ? *call.token : 0;
  Answer answer = evaluate(table, call, response);
  if (answer.status != GRAINLAW_OK || is_symmetric(response, answer.report)) return answer;
  if (call.token != nullptr) *call.token = token;
  if (call.want == 0) {  // against the stiffness, too
    PointCall with_stiffness = call;
    with_stiffness.want = GRAINLAW_WANT_TANGENT_ELASTIC;
    answer = evaluate(table, with_stiffness, response);
    if (answer.status != GRAINLAW_OK || is_symmetric(response, answer.report)) return answer;
    if (call.token != nullptr) *call.token = token;
  }
  throw std::runtime_error(
      "the stress of this packing is not symmetric (S12 and S21 differ by " +
      shown(response.asymmetry, 1) +
      " of |S|): moments act on it, or components of F are found; a host of the second "
      "Piola-Kirchhoff or Cauchy stress cannot be given it: use rotation = true and a periodic "
      "cell or frame-p, or the first Piola-Kirchhoff stress");
}

}  // namespace grainlaw::adapters

#include "point.hpp"

#include "number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainlaw::adapters {
namespace {

constexpr double rounding = 1e-12;  // of F in a host that computes it twice [-]

}  // namespace

std::string component_name(int index) {
  return {'F', static_cast<char>('1' + index / 3), static_cast<char>('1' + index % 3)};
}

double time_step_of(double told) { return std::isfinite(told) ? std::max(told, 0.0) : 0; }

Point::Point(const grainlaw::Material& material)
    : state_(material), dimension_(material.dimension()) {}

double Point::distance(const Tensor2& F, const Tensor2& other) {
  double largest = 0;
  for (std::size_t k = 0; k < F.size(); ++k) {
    const double difference = std::abs(F[k] - other[k]);
    if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference);
  }
  return largest;
}

bool Point::is_trial(const Tensor2& F) const {
  return has_trial_ && distance(F, trial_) <= rounding;
}

Answer Point::evaluate(const Tensor2& F, unsigned want, Response& response) {
  for (int k = 0; k < 9; ++k) {
    const double value = F[static_cast<std::size_t>(k)];
    if (!std::isfinite(value)) {
      throw std::runtime_error(component_name(k) + " of the deformation gradient is " +
                               shown(value) + "; a finite number was expected");
    }
  }
  double reduced[9], P[9], A[81];
  if (const int wrong = reduce(dimension_, F, reduced); wrong >= 0) {
    throw std::runtime_error(
        component_name(wrong) + " is " + shown(F[static_cast<std::size_t>(wrong)], 9) +
        ", but this packing of discs is plane strain in the 1-2 plane: F33 = 1 and F13, F23, F31, "
        "F32 = 0 were expected; hold the displacements along 3");
  }
  has_trial_ = false;
  Answer answer;
  answer.status =
      grainlaw_evaluate(state_.get(), reduced, want, P, want != 0 ? A : nullptr, &answer.report);
  if (answer.status < 0) throw grainlaw::StatusError(answer.status, answer.report.message);
  if (answer.status != GRAINLAW_OK) return answer;
  has_trial_ = true;
  trial_ = F;
  answer.approximate = answer.report.history_advanced != 0;
  response.F = F;
  complete(dimension_, P, want != 0 ? A : nullptr, response);
  return answer;
}

Answer Point::evaluate_symmetric(const Tensor2& F, unsigned want, Response& response) {
  Answer answer = evaluate(F, want, response);
  if (answer.status != GRAINLAW_OK || is_symmetric(response, answer.report)) return answer;
  if (want == 0) {  // against the stiffness, too
    revert();
    answer = evaluate(F, GRAINLAW_WANT_TANGENT_ELASTIC, response);
    if (answer.status != GRAINLAW_OK || is_symmetric(response, answer.report)) {
      return answer;
    }
  }
  revert();
  throw std::runtime_error(
      "the stress of this packing is not symmetric (S12 and S21 differ by " +
      shown(response.asymmetry, 1) +
      " of |S|): moments act on it, or components of F are found; a host of the second "
      "Piola-Kirchhoff or Cauchy stress cannot be given it: use rotation = true and a periodic "
      "cell or frame-p, or the first Piola-Kirchhoff stress");
}

void Point::accept(const Tensor2& F) {
  if (!is_trial(F)) {
    Response unused;
    const Answer answer = evaluate(F, 0, unused);
    if (answer.status != GRAINLAW_OK) {
      throw std::runtime_error(
          std::string("the host goes on from a deformation gradient at which the packing finds no "
                      "equilibrium: ") +
          grainlaw_status_text(answer.status));
    }
  }
  state_.commit();
  committed_ = trial_;
  has_trial_ = false;
}

std::size_t Point::bytes() const {
  std::size_t size = 0;
  grainlaw::check(grainlaw_state_save(state_.get(), nullptr, &size));
  return 2 * size;
}

void Point::revert() {
  state_.revert();
  has_trial_ = false;
}

}  // namespace grainlaw::adapters

// Linear solves with the stiffness of many spheres by Krylov methods; factors replace them where
// they stall.
#include "base/constants.hpp"
#include "tangent/stiffness.hpp"

#include <algorithm>

namespace grainlaw::core {

// Prepares the Krylov methods. It counts as a factorisation, since each Newton iteration has one.
template <>
void Stiffness<3>::prepare_iteration(Increment<3>& increment) {
  ++increment.cost.factorisations;
  factorised_ = increment.epoch();
  regularise(increment, tuned::incomplete_regularisation);
  iterative_.prepare(matrix_, regularisation_);
}

// Solves a Newton step. Where the method stalls the caller's shift helps and costs less than
// factors.
template <>
bool Stiffness<3>::solve_step(Increment<3>& increment, std::span<const double> b, double forcing,
                              std::span<double> x) {
  if (!iterates()) {
    factorise(increment);
    return solve(increment, b, x);
  }
  prepare_iteration(increment);
  set_right(b);
  const double left = iterative_.solve<Column>(
      matrix_, right_, solution_, {forcing, increment.scale().rounding(), most_products_});
  give_solution(x);
  return left <= std::max(forcing, tuned::usable_step);
}

template <>
bool Stiffness<3>::iterate_together(Increment<3>& increment, std::span<const Together<width>> b,
                                    std::span<Together<width>> x) {
  const double tolerance = increment.problem().tolerance;
  // Soft modes amplify the residual, so derivatives are as accurate as the equilibrium asks for.
  const double fine = std::min(tuned::derivative_residual, tuned::share_of_tolerance * tolerance);
  const double enough =
      std::clamp(tuned::derivative_share * tolerance, fine, tuned::loose_derivative_residual);
  prepare_iteration(increment);
  const double floor = increment.scale().rounding() / enough;
  return iterative_.solve<Together<width>>(matrix_, b, x, {enough, floor, most_products_}) <=
         enough;
}

}  // namespace grainlaw::core

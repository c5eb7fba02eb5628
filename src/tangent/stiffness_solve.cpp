// Linear solves with the stiffness: factors with refinement, and GMRES where these fail.
#include "base/capacity.hpp"
#include "base/constants.hpp"
#include "linear/largest.hpp"
#include "tangent/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

template <class Register>
Register largest_in_lanes(std::span<const Register> values) {
  Register result;
  largest_by_lane<sizeof(Register) / sizeof(double)>(values.data()->lane, values.size(),
                                                     result.lane);
  return result;
}

template <class Register>
double largest_of(const std::vector<Register>& values, std::size_t count) {
  const Register result = largest_in_lanes<Register>(std::span(values).first(count));
  return *std::max_element(std::begin(result.lane), std::end(result.lane));
}

GRAINLAW_CLONES void add_doubles(double* to, const double* values, std::size_t count) {
  for (std::size_t k = 0; k < count; k += 4) {
    simd::store(to + k, simd::load<4>(to + k) + simd::load<4>(values + k));
  }
}

template <class Register>
void add_to(std::span<Register> to, const std::vector<Register>& values) {
  constexpr std::size_t doubles = sizeof(Register) / sizeof(double);
  add_doubles(to.data()->lane, values.data()->lane, to.size() * doubles);
}

}  // namespace

// Sets the regularisation of the diagonal, for the factors alone.
template <int D>
void Stiffness<D>::regularise(const Increment<D>& increment, double share) {
  const auto b = static_cast<std::size_t>(matrix_.components);
  resize_with_capacity(regularisation_, matrix_.nodes);
  for (std::size_t q = 0; q < matrix_.nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) {
      regularisation_[q].lane[k] = share * increment.masses().of_unknowns()[k * matrix_.nodes + q];
    }
  }
}

template <int D>
void Stiffness<D>::factorise(Increment<D>& increment) {
  ++increment.cost.factorisations;
  lu_.analyse(matrix_, factorised_ == increment.epoch());
  factorised_ = increment.epoch();
  gmres_.reserve(matrix_.nodes);
  regularise(increment, tuned::regularisation);
  factors_ = lu_.factorise(matrix_, regularisation_) ? Factors::of_matrix : Factors::none;
}

template <int D>
void Stiffness<D>::set_right(std::span<const double> b) {
  const auto nodes = matrix_.nodes;
  const auto components = static_cast<std::size_t>(matrix_.components);
  resize_with_capacity(right_, nodes);
  resize_with_capacity(solution_, nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    right_[q] = {};
    for (std::size_t k = 0; k < components; ++k) right_[q].lane[k] = b[k * nodes + q];
  }
}

template <int D>
void Stiffness<D>::give_solution(std::span<double> x) const {
  const auto nodes = matrix_.nodes;
  const auto components = static_cast<std::size_t>(matrix_.components);
  for (std::size_t q = 0; q < nodes; ++q) {
    for (std::size_t k = 0; k < components; ++k) x[k * nodes + q] = solution_[q].lane[k];
  }
}

template <int D>
bool Stiffness<D>::solve(const Increment<D>& increment, std::span<const double> b,
                         std::span<double> x, double tolerance) {
  if (factors_ != Factors::of_matrix) return false;
  const auto nodes = matrix_.nodes;
  set_right(b);
  resize_with_capacity(check_, nodes);
  const double scale = std::max(largest_of(right_, nodes), std::numeric_limits<double>::min());
  // Right-hand sides below rounding have no meaningful solution: a residual within rounding is
  // accepted.
  const double enough = std::max(tuned::usable_solution, increment.scale().rounding() / scale);
  const auto defect = [&] {
    matrix_.residual(right_, solution_, check_);
    return largest_of(check_, nodes) / scale;
  };
  std::copy(right_.begin(), right_.end(), solution_.begin());
  lu_.solve(solution_);
  double error = defect();
  for (double last = 4 * error; error > tolerance && error < tuned::slow_refinement * last;) {
    lu_.solve(check_);
    add_to(std::span(solution_), check_);
    last = error;
    error = defect();
  }
  if (!(error <= enough) && !solve_by_gmres(increment)) return false;
  give_solution(x);
  return true;
}

template <>
bool Stiffness<2>::solve_step(Increment<2>& increment, std::span<const double> b,
                              double /*forcing*/, std::span<double> x) {
  factorise(increment);
  return solve(increment, b, x);
}

// Solves from right_ to solution_ by GMRES.
template <int D>
bool Stiffness<D>::solve_by_gmres(const Increment<D>& increment) {
  gmres_.solve(matrix_, lu_, tuned::good_solution, right_, solution_);
  resize_with_capacity(check_, matrix_.nodes);
  matrix_.residual(right_, solution_, check_);
  return largest_of(check_, matrix_.nodes) <=
         std::max(tuned::usable_solution * largest_of(right_, matrix_.nodes),
                  increment.scale().rounding());
}

// Solves for all lanes with the factors; the largest residual decides.
template <int D>
bool Stiffness<D>::solve_together_by_factors(const Increment<D>& increment,
                                             std::span<const Together<width>> b,
                                             std::span<Together<width>> x) {
  const bool earlier = factors_ == Factors::of_earlier_matrix;
  const double floor = increment.scale().rounding() / tuned::usable_solution;
  const auto scale = largest_in_lanes(b);
  const auto defect = [&] {
    matrix_.residual_together(b, x, check_together_);
    const auto most = largest_in_lanes<Together<width>>(check_together_);
    double error = 0;
    for (std::size_t k = 0; k < width; ++k) {
      error = std::max(error, most.lane[k] / std::max(scale.lane[k], floor));
    }
    return error;
  };
  const auto needed = [=](double error) {
    return earlier && error > tuned::settled_solution ? tuned::quick_refinement
                                                      : tuned::slow_refinement;
  };
  std::copy(b.begin(), b.end(), x.begin());
  lu_.solve_together(x);
  double error = defect();
  double last = 1;
  while (error > tuned::good_together && error < needed(error) * last) {
    std::copy(x.begin(), x.end(), kept_.begin());
    lu_.solve_together(check_together_);
    add_to(x, check_together_);
    last = error;
    error = defect();
  }
  if (last <= tuned::usable_solution && error > last) {  // nearly singular matrix
    std::copy(kept_.begin(), kept_.end(), x.begin());
    error = last;
  }
  return error <= (earlier ? tuned::settled_solution : tuned::usable_solution);
}

template <int D>
bool Stiffness<D>::solve_together(Increment<D>& increment, std::span<const Together<width>> b,
                                  std::span<Together<width>> x) {
  if constexpr (D == 3) {
    if (iterates() && iterate_together(increment, b, x)) return true;
  }
  resize_with_capacity(check_together_, b.size());
  resize_with_capacity(kept_, b.size());
  if (factors_ == Factors::of_earlier_matrix && solve_together_by_factors(increment, b, x)) {
    return true;
  }
  if (factors_ != Factors::of_matrix) factorise(increment);
  if (factors_ != Factors::of_matrix) return false;
  if (solve_together_by_factors(increment, b, x)) return true;
  const auto nodes = matrix_.nodes;
  const auto components = static_cast<std::size_t>(matrix_.components);
  resize_with_capacity(right_, nodes);
  resize_with_capacity(solution_, nodes);
  for (std::size_t l = 0; l < width; ++l) {
    for (std::size_t q = 0; q < nodes; ++q) {
      right_[q] = {};
      for (std::size_t k = 0; k < components; ++k) {
        right_[q].lane[k] = b[q * components + k].lane[l];
      }
    }
    if (!solve_by_gmres(increment)) return false;
    for (std::size_t q = 0; q < nodes; ++q) {
      for (std::size_t k = 0; k < components; ++k) {
        x[q * components + k].lane[l] = solution_[q].lane[k];
      }
    }
  }
  return true;
}

template <int D>
std::vector<double> Stiffness<D>::product(std::span<const double> x) const {
  const auto nodes = matrix_.nodes;
  const auto components = static_cast<std::size_t>(matrix_.components);
  std::vector<Column> of_nodes(nodes), minus(nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    for (std::size_t k = 0; k < components; ++k) of_nodes[q].lane[k] = x[k * nodes + q];
  }
  matrix_.subtract_product(of_nodes, minus);
  std::vector<double> result(x.size());
  for (std::size_t q = 0; q < nodes; ++q) {
    for (std::size_t k = 0; k < components; ++k) result[k * nodes + q] = -minus[q].lane[k];
  }
  return result;
}

#define GRAINLAW_FOR(D)                                                                      \
  template void Stiffness<D>::regularise(const Increment<D>&, double);                       \
  template void Stiffness<D>::set_right(std::span<const double>);                            \
  template void Stiffness<D>::give_solution(std::span<double>) const;                        \
  template void Stiffness<D>::factorise(Increment<D>&);                                      \
  template std::vector<double> Stiffness<D>::product(std::span<const double>) const;         \
  template bool Stiffness<D>::solve(const Increment<D>&, std::span<const double>,            \
                                    std::span<double>, double);                              \
  template bool Stiffness<D>::solve_together(Increment<D>&,                                  \
                                             std::span<const Together<Dimension<D>::lanes>>, \
                                             std::span<Together<Dimension<D>::lanes>>);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

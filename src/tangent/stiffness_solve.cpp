// Linear solves with the stiffness: factors, their refinement, and GMRES where that does not do.
#include "base/room.hpp"
#include "linear/quad.hpp"
#include "tangent/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

using namespace quad;

namespace {

// Holds rattlers and the translation of the cell in the factors, relative to the masses; refinement
// takes it out of the solution again.
constexpr double grounding = 1e-12;
// Of a residual relative to the largest entry of the right-hand side: of GMRES, of four together.
constexpr double good = 1e-12;
constexpr double good_of_four = 1e-10;
constexpr double usable = 1e-6;
// Refinement goes on while it falls to less than this share. With old factors it has to be quick,
// or a factorisation is cheaper; below `settled` what stays is rounding, by whatever factors.
constexpr double slow = 0.5;
constexpr double quick = 0.05;
constexpr double settled = 1e-9;

// Largest magnitude by lane; infinite where a number is not finite.
GRAINLAW_CLONES void largest_by_lane(std::span<const Quad> values, Quad& result) {
  Lanes most{};
  Lanes poison{};
  for (const auto& value : values) {
    const Lanes v = load(value.lane);
    most = simd::largest(most, simd::magnitude(v));
    poison += v * 0.0;
  }
  for (std::size_t k = 0; k < width; ++k) {
    result.lane[k] = poison[k] == 0 ? most[k] : std::numeric_limits<double>::infinity();
  }
}

double largest_of(std::span<const Quad> values) {
  Quad result;
  largest_by_lane(values, result);
  return *std::max_element(std::begin(result.lane), std::end(result.lane));
}

GRAINLAW_CLONES void add_to(std::span<Quad> to, std::span<const Quad> values) {
  for (std::size_t k = 0; k < to.size(); ++k) {
    store(to[k].lane, load(to[k].lane) + load(values[k].lane));
  }
}

}  // namespace

void Stiffness::factorise(Increment& increment) {
  const bool first = increment.factorisations++ == 0;
  lu_.analyse(matrix_, !first);
  gmres_.reserve(matrix_.nodes);
  const auto b = static_cast<std::size_t>(matrix_.components);
  resize_with_room(ground_, matrix_.nodes);
  for (std::size_t q = 0; q < matrix_.nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) {
      ground_[q].lane[k] = grounding * increment.mass[k * matrix_.nodes + q];
    }
  }
  factors_ = lu_.factorise(matrix_, ground_) ? Factors::of_matrix : Factors::none;
}

bool Stiffness::solve(const Increment& increment, std::span<const double> b, std::span<double> x,
                      double tolerance) {
  if (factors_ != Factors::of_matrix) return false;
  const auto nodes = matrix_.nodes;
  const auto components = static_cast<std::size_t>(matrix_.components);
  resize_with_room(right_, nodes);
  resize_with_room(solution_, nodes);
  resize_with_room(check_, nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    right_[q] = {};
    for (std::size_t k = 0; k < components; ++k) right_[q].lane[k] = b[k * nodes + q];
  }
  const double scale = std::max(largest_of(right_), std::numeric_limits<double>::min());
  // Of a right-hand side that is rounding alone nothing can be solved for.
  const double enough = std::max(usable, increment.rounding_force() / scale);
  const auto defect = [&] {
    matrix_.residual(right_, solution_, check_);
    return largest_of(check_) / scale;
  };
  std::copy(right_.begin(), right_.end(), solution_.begin());
  lu_.solve(solution_);
  double error = defect();
  for (double last = 4 * error; error > tolerance && error < slow * last;) {
    lu_.solve(check_);
    add_to(solution_, check_);
    last = error;
    error = defect();
  }
  if (!(error <= enough) && !solve_by_gmres(increment)) return false;
  for (std::size_t q = 0; q < nodes; ++q) {
    for (std::size_t k = 0; k < components; ++k) x[k * nodes + q] = solution_[q].lane[k];
  }
  return true;
}

// From right_ to solution_.
bool Stiffness::solve_by_gmres(const Increment& increment) {
  gmres_.solve(matrix_, lu_, good, right_, solution_);
  const auto check = std::span(check_).first(matrix_.nodes);
  matrix_.residual(right_, solution_, check);
  return largest_of(check) <= std::max(usable * largest_of(right_), increment.rounding_force());
}

// The worst of the four residuals counts.
bool Stiffness::solve_four_by_factors(const Increment& increment, std::span<const Quad> b,
                                      std::span<Quad> x) {
  const bool earlier = factors_ == Factors::of_earlier_matrix;
  const double floor = increment.rounding_force() / usable;
  Quad scale;
  largest_by_lane(b, scale);
  const auto defect = [&] {
    matrix_.residual_of_four(b, x, check_);
    Quad most;
    largest_by_lane(check_, most);
    double error = 0;
    for (std::size_t k = 0; k < width; ++k) {
      error = std::max(error, most.lane[k] / std::max(scale.lane[k], floor));
    }
    return error;
  };
  const auto needed = [=](double error) { return earlier && error > settled ? quick : slow; };
  std::copy(b.begin(), b.end(), x.begin());
  lu_.solve_four(x);
  double error = defect();
  double last = 1;
  while (error > good_of_four && error < needed(error) * last) {
    std::copy(x.begin(), x.end(), kept_.begin());
    lu_.solve_four(check_);
    add_to(x, check_);
    last = error;
    error = defect();
  }
  if (last <= usable && error > last) {  // of a nearly singular matrix it rises again
    std::copy(kept_.begin(), kept_.end(), x.begin());
    error = last;
  }
  return error <= (earlier ? settled : usable);
}

bool Stiffness::solve_four(Increment& increment, std::span<const Quad> b, std::span<Quad> x) {
  resize_with_room(check_, b.size());
  resize_with_room(kept_, b.size());
  if (factors_ == Factors::of_earlier_matrix && solve_four_by_factors(increment, b, x)) return true;
  if (factors_ != Factors::of_matrix) factorise(increment);
  if (factors_ != Factors::of_matrix) return false;
  if (solve_four_by_factors(increment, b, x)) return true;
  const auto nodes = matrix_.nodes;
  const auto components = static_cast<std::size_t>(matrix_.components);
  resize_with_room(right_, nodes);
  resize_with_room(solution_, nodes);
  for (std::size_t l = 0; l < width; ++l) {
    for (std::size_t q = 0; q < nodes; ++q) {
      right_[q] = {};
      for (std::size_t k = 0; k < components; ++k)
        right_[q].lane[k] = b[q * components + k].lane[l];
    }
    if (!solve_by_gmres(increment)) return false;
    for (std::size_t q = 0; q < nodes; ++q) {
      for (std::size_t k = 0; k < components; ++k)
        x[q * components + k].lane[l] = solution_[q].lane[k];
    }
  }
  return true;
}

}  // namespace grainlaw

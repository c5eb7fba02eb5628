#include "brick/newton.hpp"

#include <fmt/format.h>
#include <Eigen/SparseLU>

#include <algorithm>
#include <limits>

namespace verification {
namespace {

// Iterations in a row without halving the residual that end an attempt: it alternates across a jump
// of P.
constexpr int patience = 4;

// Displacement change of the linearised system; NaN where it is singular.
Eigen::VectorXd solve(const BrickSystem& system, const BrickUnknowns& unknowns,
                      const Eigen::VectorXd& prescribed) {
  const Eigen::VectorXd force = unknowns.reduce(system.residual - system.stiffness * prescribed);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int column = 0; column < system.stiffness.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(system.stiffness, column); entry;
         ++entry) {
      const int i = unknowns.number[static_cast<std::size_t>(entry.row())];
      const int k = unknowns.number[static_cast<std::size_t>(entry.col())];
      if (i >= 0 && k >= 0) triplets.emplace_back(i, k, entry.value());
    }
  Eigen::SparseMatrix<double> reduced(unknowns.count, unknowns.count);
  reduced.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(reduced);
  if (factor.info() != Eigen::Success)
    return Eigen::VectorXd::Constant(prescribed.size(), std::numeric_limits<double>::quiet_NaN());
  return prescribed + unknowns.expand(factor.solve(force));
}

}  // namespace

BrickNewton::BrickNewton(const BrickModel& model, const Material& material,
                         const BrickNewtonOptions& options, int threads)
    : options_(options),
      unknowns_(model),
      field_(model, material, threads),
      displacement_(Eigen::VectorXd::Zero(unknowns_.end.size())) {
  if (unknowns_.count == 0) throw InputError("every displacement is prescribed: nothing to solve");
  check(field_.evaluate(displacement_, GRAINLAW_WANT_TANGENT_EXACT),
        "evaluating the integration points at F = I");
  system_ = field_.assemble(displacement_);
  field_.commit();
  field_.record();  // excludes the start from step 0
}

// Finds the equilibrium at a time. The increment of prescribed displacement enters the right-hand
// side of the first solve, which extrapolates the committed equilibrium with its tangent.
Attempt BrickNewton::equilibrate(double time, double tolerance, std::vector<double>& residuals) {
  Eigen::VectorXd displacement = displacement_;
  BrickSystem system = system_;
  Eigen::VectorXd prescribed = (time - time_) * unknowns_.end;
  residuals.push_back(unknowns_.reduce(system.residual - system.stiffness * prescribed).norm() /
                      system.scale);
  field_.set_time_step(time > time_ ? (time - time_) / options_.load_step : 1);
  double best = std::numeric_limits<double>::infinity();
  int best_iteration = 0;
  bool stalled = false;
  for (int iteration = 0; iteration < options_.max_iterations && !stalled; ++iteration) {
    const Eigen::VectorXd correction = solve(system, unknowns_, prescribed);
    if (!correction.allFinite()) return {.reason = "the stiffness is singular"};
    const double share = std::min(1.0, largest_correction / field_.largest_change(correction));
    displacement += share * correction;
    prescribed *= 1 - share;
    const auto status = field_.evaluate(displacement, GRAINLAW_WANT_TANGENT_EXACT);
    if (status != GRAINLAW_OK) {
      const grainlaw_summary& summary = field_.summary();
      residuals.push_back(std::numeric_limits<double>::quiet_NaN());
      return {.ratio = summary.step_ratio,
              .reason = fmt::format("point {}: {}", summary.first_failed, summary.message),
              .status = status};
    }
    system = field_.assemble(displacement);
    const double residual =
        unknowns_.reduce(system.residual - system.stiffness * prescribed).norm() / system.scale;
    residuals.push_back(residual);
    if (residual <= tolerance && prescribed.isZero(0)) {
      displacement_ = displacement;
      system_ = system;
      time_ = time;
      return {.converged = true};
    }
    if (residual < 0.5 * best) {
      best = residual;
      best_iteration = iteration;
    }
    stalled = iteration >= best_iteration + patience;
  }
  return {.stalled = stalled,
          .reason = fmt::format("Newton did not converge: best relative residual {:.1e}, expected "
                                "{:.1e} [-]",
                                best, tolerance)};
}

BrickStep BrickNewton::advance(double to, int number, const CutObserver& observe_cut) {
  BrickStep step;
  int iterations = 0;
  const auto attempt = [&](double next, bool loose) {
    const auto first = step.residuals.size();
    const Attempt result =
        equilibrate(next, loose ? options_.loose_tolerance : options_.tolerance, step.residuals);
    iterations += static_cast<int>(step.residuals.size() - first) - 1;
    if (result.converged)
      field_.commit();
    else
      field_.revert();
    return result;
  };
  const Parts parts =
      solve_in_parts(time_, to, fmt::format("load step {}", number), options_.max_cuts,
                     options_.loose_tolerance > 0, attempt, observe_cut);
  step.record = field_.record();
  step.record.step = number;
  step.record.effort.iterations = iterations;
  step.record.effort.cuts = parts.cuts;
  step.record.effort.loose = parts.loose;
  return step;
}

}  // namespace verification

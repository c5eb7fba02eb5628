#include "fe/solver/relaxation.hpp"

#include "fe/mesh/mass.hpp"
#include "fe/solver/forces.hpp"
#include "fe/solver/frequency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace verification {
namespace {

// State on which the next load step depends, besides the committed points.
struct Rest {
  double time = 0;
  Eigen::VectorXd displacement;  // [m]
  Eigen::VectorXd imbalance;     // external minus internal force [N/m]
  Eigen::VectorXd rate;          // velocity of the unknowns in the last part, per unit of time [m]
};

class RelaxationSolver final : public Solver {
 public:
  RelaxationSolver(const Model& model, const Material& material, const RelaxationOptions& options,
                   int threads)
      : model_(model),
        options_(options),
        threads_(threads),
        dofs_(number_dofs(model)),
        points_(model, material),
        mass_(lumped_mass(model.mesh, 1)),
        unknown_mass_(dofs_.reduce_mass(mass_)) {
    if (dofs_.unknowns == 0) throw InputError("every displacement is prescribed: nothing to solve");
    rest_.displacement = Eigen::VectorXd::Zero(mass_.size());
    rest_.rate = rest_.displacement;
    check(points_.evaluate(rest_.displacement, 0, threads_),
          "evaluating the integration points at F = I");
    points_.commit();
    points_.record();  // excludes the start from step 0
  }

  LoadStep advance(double to, int number) override {
    LoadStep step;
    int iterations = 0;
    const auto attempt = [&](double load, double length) {
      step.attempts.push_back(step.residuals.size());
      points_.set_time_step(passed_time(length));
      auto refusal = relax(load, step.residuals, iterations);
      if (refusal)
        points_.revert();
      else
        step.balance = std::max(step.balance, step.residuals.back());
      return refusal;
    };
    grainlaw_march_options march = grainlaw_march_options_default();
    march.max_cuts = options_.max_cuts;
    const Parts parts = make_step({.from = rest_.time,
                                   .to = to,
                                   .name = fmt::format("load step {}", number),
                                   .options = march,
                                   .observe_cut = observe_cut_},
                                  attempt);
    step.time = to;
    step.record = points_.record();
    step.record.step = number;
    step.record.effort.iterations = iterations;
    step.record.effort.cuts = parts.cuts;
    report_supports(model_, to, rest_.displacement, rest_.imbalance, step);
    return step;
  }

  void save(CheckpointWriter& out) const override {
    out.write(rest_.time);
    for (const auto* field : {&rest_.displacement, &rest_.imbalance, &rest_.rate})
      out.write(*field);
    points_.save(out);
  }

  void restore(CheckpointReader& in) override {
    in.read(rest_.time);
    for (auto* field : {&rest_.displacement, &rest_.imbalance, &rest_.rate}) in.read(*field);
    points_.restore(in);
  }

  [[nodiscard]] const PointField& points() const override { return points_; }
  [[nodiscard]] const Eigen::VectorXd& displacement() const override { return rest_.displacement; }

 private:
  struct Balance {
    Eigen::VectorXd internal;   // [N/m]
    Eigen::VectorXd imbalance;  // [N/m]
    Eigen::VectorXd force;      // the imbalance of the unknowns [N/m]
    double residual = 0;        // [-]
  };

  [[nodiscard]] Balance balance(const Eigen::VectorXd& displacement, double time) const {
    Balance result;
    result.internal = points_.internal_force();
    result.imbalance = -result.internal;
    add_external_force(model_, time, displacement, result.imbalance);
    result.force = dofs_.reduce(result.imbalance);
    result.residual =
        result.force.norm() / std::max(result.internal.norm(), std::numeric_limits<double>::min());
    return result;
  }

  // Prescribed displacement and jumps since the committed time [m].
  [[nodiscard]] Eigen::VectorXd told(double time) const {
    return dofs_.prescribed_at(time) - dofs_.prescribed_at(rest_.time);
  }

  std::optional<Refusal> relax(double time, std::vector<double>& residuals, int& iterations) {
    // Extrapolates the committed equilibrium at the velocity of the last part.
    const Eigen::VectorXd origin =
        rest_.displacement + told(time) + (time - rest_.time) * rest_.rate;
    Eigen::VectorXd displacement = origin;
    Balance now;
    Eigen::VectorXd first_internal;
    Eigen::VectorXd velocity = Eigen::VectorXd::Zero(dofs_.unknowns);
    double highest = 0;  // frequency, with the bounding elastic tangents [1/s]
    double lowest = 0;   // frequency, of the motion since the start [1/s]
    for (int iteration = 0;; ++iteration) {
      const bool first = iteration == 0;
      const unsigned want = first ? unsigned{GRAINLAW_WANT_TANGENT_ELASTIC} : 0U;
      if (const auto status = points_.evaluate(displacement, want, threads_); status != GRAINLAW_OK)
        return Refusal{points_.message(), points_.step_ratio(), status};
      now = balance(displacement, time);
      residuals.push_back(now.residual);
      if (now.residual <= options_.tolerance) break;
      if (first) {
        first_internal = now.internal;
        highest = highest_frequency(points_, dofs_, mass_);
        if (highest == 0) return Refusal{.reason = "the packings have no stiffness"};
      }
      if (!std::isfinite(now.residual) || iteration == options_.max_iterations)
        return Refusal{
            .reason = fmt::format("dynamic relaxation did not converge in {} iterations (relative "
                                  "residual {:.1e} [-])",
                                  iteration, now.residual)};
      // Rayleigh quotient (eq. 26) of the displacement since the start, without the supports'.
      const Eigen::VectorXd moved = displacement - origin;
      const double inertia = moved.dot(mass_.cwiseProduct(moved));
      const double work = moved.dot(now.internal - first_internal);
      if (inertia > 0 && work > 0) lowest = std::sqrt(work / inertia);
      const double damping = 2 * options_.damping_ratio * std::min(lowest, highest);
      // Central differences (eqs. 21-23), at rest half a step before the start.
      const double step = options_.safety * 2 / highest;
      const double h = first ? 0.5 * step : step;
      velocity = ((2 - h * damping) * velocity + 2 * h * now.force.cwiseQuotient(unknown_mass_)) /
                 (2 + h * damping);
      displacement += step * dofs_.expand(velocity);
      ++iterations;
    }
    points_.commit();
    if (time > rest_.time)
      rest_.rate = (displacement - rest_.displacement - told(time)) / (time - rest_.time);
    rest_.displacement = displacement;
    rest_.imbalance = now.imbalance;
    rest_.time = time;
    return {};
  }

  const Model& model_;
  RelaxationOptions options_;
  int threads_;
  Dofs dofs_;
  PointField points_;
  Eigen::VectorXd mass_;          // of the components at density 1 [kg/m]
  Eigen::VectorXd unknown_mass_;  // of the unknowns [kg/m]
  Rest rest_;
};

}  // namespace

std::unique_ptr<Solver> make_relaxation_solver(const Model& model, const Material& material,
                                               const RelaxationOptions& options, int threads) {
  return std::make_unique<RelaxationSolver>(model, material, options, threads);
}

}  // namespace verification

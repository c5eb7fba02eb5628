#include "fe/solver/dynamics.hpp"

#include "fe/mesh/mass.hpp"
#include "fe/solver/forces.hpp"
#include "fe/solver/frequency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

// State on which the next time step depends, besides the committed points.
struct Motion {
  double time = 0;                 // [s]
  double last_step = 0;            // last time step [s]
  Eigen::VectorXd displacement;    // at `time` [m]
  Eigen::VectorXd velocity;        // half of the last step before `time` [m/s]
  Eigen::VectorXd internal_force;  // at `time` [N/m]
  Energies
      work;  // external, damped: until half of the last step before `time`; internal: until `time`
  double turnover = 0;       // initial energy + sum of |increments of external work| [J/m]
  double critical_step = 0;  // [s]
};

// Change at the present time: the velocity jumps from half a step before to half a step after.
struct Kick {
  Eigen::VectorXd velocity;  // half of the next step after `time` [m/s]
  Eigen::VectorXd force;     // of loads and supports [N/m]
  Eigen::VectorXd support;   // of supports alone [N/m]
  Eigen::VectorXd damping;   // [N/m]
  double zigzag = 0;         // kinetic energy of the jump [J/m]
};

class DynamicsSolver final : public Solver {
 public:
  DynamicsSolver(const Model& model, const Material& material, const DynamicsOptions& options,
                 int threads)
      : model_(model),
        options_(options),
        threads_(threads),
        dofs_(number_dofs(model)),
        points_(model, material),
        mass_(lumped_mass(model.mesh, options.density)),
        unknown_mass_(dofs_.reduce_mass(mass_)) {
    motion_.displacement = Eigen::VectorXd::Zero(mass_.size());
    motion_.velocity = motion_.displacement;
    if (dofs_.masses_coupled(mass_))
      throw InputError(
          "dynamics: found a platen that turns about a hinge away from the centre of the mass on "
          "it, expected the hinge there, or the motion of the platen prescribed");
    check(points_.evaluate(motion_.displacement, tangent(), threads_),
          "evaluating the integration points at F = I");
    motion_.internal_force = points_.internal_force();
    motion_.critical_step = critical_step();
    if (options_.time_step == 0 && !std::isfinite(motion_.critical_step))
      throw InputError(
          "dynamics: the packings have no stiffness at F = I, so no critical time step can be "
          "estimated: give time_step");
    points_.commit();
    const double energy_density = points_.record().elastic_energy /
                                  measure_scalar(points_.state(0), GRAINLAW_REFERENCE_VOLUME);
    motion_.turnover =
        energy_density * (1.0 / points_.dimension()) * mass_.sum() / options_.density;
  }

  LoadStep advance(double to, int number) override {
    LoadStep step;
    int cuts = 0;
    int time_steps = 0;
    const double limit = longest_step();
    while (motion_.time < to) {
      const double left = to - motion_.time;
      const double parts = std::max(1.0, std::ceil(left / limit * (1 - 1e-12)));
      double length = left / parts;
      const bool last = parts == 1;
      const double shortest = std::ldexp(length, -grainlaw_march_options_default().max_cuts);
      bool whole = true;
      // The tangents at the end give the next estimate of the time step.
      while (!attempt(length, last && whole ? to : motion_.time + length, last ? tangent() : 0)) {
        points_.revert();
        ++cuts;
        whole = false;
        const double shorter = length * grainlaw_march_cut(points_.step_ratio());
        if (shorter < shortest)
          throw ComputationError(
              fmt::format("step {} failed at time {:.6g} s with a time step of "
                          "{:.2e} s: {}",
                          number, motion_.time, length, points_.message()));
        length = shorter;
      }
      ++time_steps;
    }
    if (tangent() != 0 && time_steps > 0) {
      const double found = critical_step();
      if (std::isfinite(found)) motion_.critical_step = found;  // not finite: no contact bears
    }
    report(step);
    step.time = to;
    step.record = points_.record();
    step.record.step = number;
    step.record.effort.iterations = time_steps;
    step.record.effort.cuts = cuts;
    return step;
  }

  void save(CheckpointWriter& out) const override {
    const Motion& now = motion_;
    for (const double value : {now.time, now.last_step, now.turnover, now.critical_step,
                               now.work.internal, now.work.external, now.work.damped})
      out.write(value);
    for (const auto* field : {&now.displacement, &now.velocity, &now.internal_force})
      out.write(*field);
    points_.save(out);
  }

  void restore(CheckpointReader& in) override {
    Motion& now = motion_;
    for (double* value : {&now.time, &now.last_step, &now.turnover, &now.critical_step,
                          &now.work.internal, &now.work.external, &now.work.damped})
      in.read(*value);
    for (auto* field : {&now.displacement, &now.velocity, &now.internal_force}) in.read(*field);
    points_.restore(in);
  }

  [[nodiscard]] const PointField& points() const override { return points_; }
  [[nodiscard]] const Eigen::VectorXd& displacement() const override {
    return motion_.displacement;
  }

 private:
  [[nodiscard]] double longest_step() const {
    return options_.time_step > 0 ? options_.time_step : options_.safety * motion_.critical_step;
  }

  [[nodiscard]] unsigned tangent() const {
    return options_.time_step > 0 ? 0U : unsigned{GRAINLAW_WANT_TANGENT_ELASTIC};
  }

  // Critical step from the tangents of the last evaluation; damping with central differences does
  // not lower it.
  [[nodiscard]] double critical_step() const {
    return tangent() == 0 ? 0 : 2 / highest_frequency(points_, dofs_, mass_);
  }

  // Momentum of the unknowns, M (v+ - v-) / h + alpha M (v+ + v-) / 2 = F, with h the mean of the
  // steps before and after. Supports follow their programs to the end of the run, and continue
  // their motion afterwards.
  [[nodiscard]] Kick kick(double length) const {
    const Motion& now = motion_;
    const double h = 0.5 * (now.last_step + length);
    const double alpha_h = options_.damping * h;
    Eigen::VectorXd load = Eigen::VectorXd::Zero(mass_.size());
    add_external_force(model_, now.time, now.displacement, load);
    const Eigen::VectorXd before = dofs_.reduce(mass_.cwiseProduct(now.velocity));
    const Eigen::VectorXd after =
        ((2 - alpha_h) * before + 2 * h * dofs_.reduce(load - now.internal_force)) / (2 + alpha_h);
    const double next = std::min(now.time + length, options_.duration);
    const bool ahead = next > now.time;
    const double from = ahead ? now.time : now.time - length;
    const Eigen::VectorXd driven =
        (dofs_.prescribed_at(ahead ? next : now.time) - dofs_.prescribed_at(from)) / length;
    Kick kick;
    kick.velocity =
        driven +
        dofs_.expand(
            (after - dofs_.reduce(mass_.cwiseProduct(driven))).cwiseQuotient(unknown_mass_));
    kick.damping = options_.damping * mass_.cwiseProduct(0.5 * (kick.velocity + now.velocity));
    kick.force =
        mass_.cwiseProduct(kick.velocity - now.velocity) / h + kick.damping + now.internal_force;
    kick.support = kick.force - load;
    kick.zigzag = 0.125 * (after - before).cwiseAbs2().cwiseQuotient(unknown_mass_).sum();
    return kick;
  }

  // Makes one time step; returns false when a point refuses it, and then changes the trials alone.
  bool attempt(double length, double next, unsigned want) {
    const Kick now = kick(length);
    const Eigen::VectorXd change = length * now.velocity;
    const Eigen::VectorXd displacement = motion_.displacement + change;
    points_.set_time_step(length);
    if (points_.evaluate(displacement, want, threads_) != GRAINLAW_OK) return false;
    // Work of the present forces over half of the last and half of the next displacement.
    const Eigen::VectorXd way = 0.5 * (motion_.last_step * motion_.velocity + change);
    const double external = now.force.dot(way);
    motion_.work.external += external;
    motion_.work.damped += now.damping.dot(way);
    motion_.turnover += std::abs(external);
    refuse_instability(now, length);
    Eigen::VectorXd force = points_.internal_force();
    motion_.work.internal += 0.5 * (motion_.internal_force + force).dot(change);
    points_.commit();
    motion_.displacement = displacement;
    motion_.velocity = now.velocity;
    motion_.internal_force = std::move(force);
    motion_.last_step = length;
    motion_.time = next;
    return true;
  }

  // Throws when energies swing too far. In a stable run the energy that alternates between time
  // steps is below (omega dt)^2 / 4 < 1 of each mode's energy. It is thus below all energy
  // supplied.
  void refuse_instability(const Kick& now, double length) const {
    if (now.zigzag <= motion_.turnover && std::isfinite(now.zigzag)) return;
    throw ComputationError(fmt::format(
        "the time step of {:.3e} s is unstable at time {:.6g} s: oscillations from one step to the "
        "next hold more energy than was brought in; expected less than 2 / (highest frequency)",
        length, motion_.time));
  }

  void report(LoadStep& step) const {
    // The next time step is unknown and taken as the last.
    const Motion& now = motion_;
    step.energies = now.work;
    const double length = now.last_step > 0 ? now.last_step : longest_step();
    const Kick next = kick(length);
    const Eigen::VectorXd way = 0.5 * now.last_step * now.velocity;
    step.energies->external += next.force.dot(way);
    step.energies->damped += next.damping.dot(way);
    const Eigen::VectorXd mean = 0.5 * (now.velocity + next.velocity);
    step.energies->kinetic = now.last_step > 0 ? 0.5 * mean.cwiseAbs2().dot(mass_) : 0;
    report_supports(model_, now.time, now.displacement, -next.support, step);
  }

  const Model& model_;
  DynamicsOptions options_;
  int threads_;
  Dofs dofs_;
  PointField points_;
  Eigen::VectorXd mass_;          // of the components [kg/m]
  Eigen::VectorXd unknown_mass_;  // of the unknowns [kg/m]
  Motion motion_;
};

}  // namespace

std::unique_ptr<Solver> make_dynamics_solver(const Model& model, const Material& material,
                                             const DynamicsOptions& options, int threads) {
  return std::make_unique<DynamicsSolver>(model, material, options, threads);
}

}  // namespace verification

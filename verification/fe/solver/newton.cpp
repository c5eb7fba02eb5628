#include "fe/solver/newton.hpp"

#include "fe/conditions/dofs.hpp"
#include "fe/solver/elastic_share.hpp"
#include "fe/solver/forces.hpp"
#include "fe/solver/last_displacement.hpp"
#include "fe/solver/linear_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace verification {
namespace {

constexpr int jump_patience = 2;    // like NewtonOptions::patience, within jump_tolerance
constexpr double slow_ratio = 0.5;  // a correction that leaves more is slow

class NewtonSolver final : public Solver {
 public:
  NewtonSolver(const Model& model, const Material& material, const NewtonOptions& options,
               int threads)
      : model_(model),
        options_(options),
        threads_(threads),
        dofs_(number_dofs(model)),
        points_(model, material),
        displacement_(Eigen::VectorXd::Zero(model.mesh.dofs())) {
    if (dofs_.unknowns == 0) throw InputError("every displacement is prescribed: nothing to solve");
    check(points_.evaluate(displacement_, options_.tangent, threads_),
          "evaluating the integration points at F = I");
    system_ = assemble(model_, points_, displacement_, 0);
    elastic_ = system_.stiffness;
    points_.commit();
    points_.record();  // excludes the start from step 0
  }

  LoadStep advance(double to, int number) override {
    LoadStep step;
    const double from = time_;
    int iterations = 0;
    int crossed = 0;
    const auto attempt = [&](double next, bool loose) {
      const auto first = step.residuals.size();
      step.attempts.push_back(first);
      const double tolerance = loose ? options_.loose_tolerance : options_.tolerance;
      const bool small = next - time_ <= crossing_part * (to - from);
      points_.set_time_step(passed_time(next - time_));
      Attempt result = equilibrate(next, tolerance, step.residuals);
      if (result.stalled && small && crosses_jumps()) {
        result = cross_jumps(next, result, step.residuals, crossed);
      }
      iterations += static_cast<int>(step.residuals.size() - first) - 1;
      if (result.converged) {
        points_.commit();
        const double left = dofs_.reduce(system_.residual).norm() / system_.scale;
        step.balance = std::max(step.balance, left);
      } else {
        points_.revert();
      }
      return result;
    };
    const Parts parts =
        solve_in_parts(from, to, fmt::format("load step {}", number), options_.max_cuts,
                       options_.loose_tolerance > 0, attempt, observe_cut_);
    step.time = to;
    step.record = points_.record();
    step.record.step = number;
    step.record.effort.iterations = iterations;
    step.record.effort.cuts = parts.cuts;
    step.record.effort.loose = parts.loose;
    step.record.effort.crossed = crossed;
    report_supports(model_, to, displacement_, system_.residual, step);
    return step;
  }

  void save(CheckpointWriter& out) const override {
    out.write(time_);
    out.write(displacement_);
    points_.save(out);
    if (options_.last_displacement_first) last_displacement_.save(out);
  }

  void restore(CheckpointReader& in) override {
    in.read(time_);
    in.read(displacement_);
    points_.restore(in);
    if (options_.last_displacement_first) last_displacement_.restore(in);
    system_ = assemble(model_, points_, displacement_, time_);
  }

  [[nodiscard]] const PointField& points() const override { return points_; }
  [[nodiscard]] const Eigen::VectorXd& displacement() const override { return displacement_; }

 private:
  // Finds the equilibrium at a time. Without a last displacement, prescribed increments enter the
  // right-hand side of the first solve. It extrapolates the committed equilibrium, so that boundary
  // values never jump alone. The part that a bounded correction leaves comes in the next.
  Attempt equilibrate(double time, double tolerance, std::vector<double>& residuals) {
    Eigen::VectorXd displacement = displacement_;
    System system = system_;
    far_ = -1;
    const Eigen::VectorXd target = dofs_.prescribed_at(time);
    Eigen::VectorXd prescribed = target - dofs_.prescribed_at(time_);
    add_load_increment(system, time);
    residuals.push_back(error(system, prescribed));
    const Eigen::VectorXd again = options_.last_displacement_first
                                      ? last_displacement_.once_more(prescribed)
                                      : Eigen::VectorXd();
    double best = std::numeric_limits<double>::infinity();
    int best_iteration = 0;
    bool stalled = false;
    ElasticShare elastic(options_.elastic_share);
    for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
      const bool follows = iteration == 0 && again.size() > 0;
      Eigen::VectorXd correction;
      {
        const auto measure = points_.cost().measure(Stage::linear_solve);
        correction = follows ? again
                     : elastic.value() == 0
                         ? solve(system.stiffness, system.residual, dofs_, prescribed)
                         : solve(system.stiffness + elastic.value() * elastic_, system.residual,
                                 dofs_, prescribed);
      }
      if (!correction.allFinite()) return {.reason = "the stiffness is singular"};
      double share = follows ? 1 : bound(correction);
      const int halvings = iteration == 0 ? 0 : options_.line_search;
      const Attempt step =
          correct(displacement, system, correction, share, time, residuals.back(), halvings);
      prescribed *= 1 - share;
      if (!step.converged) {
        residuals.push_back(std::numeric_limits<double>::quiet_NaN());
        return step;
      }
      const double before = residuals.back();
      const double residual = error(system, prescribed);
      residuals.push_back(residual);
      if (iteration > 0 && options_.elastic_share > 0) elastic.update(before, residual);
      if (residual < 0.5 * best) {
        best = residual;
        best_iteration = iteration;
      }
      const int made = iteration + 1;
      const bool loaded = prescribed.isZero(0);
      if (loaded) keep_farthest(displacement, system);
      const bool near = loaded && residual <= options_.jump_tolerance;
      const bool slow = options_.jump_iterations > 0 && made >= options_.jump_iterations &&
                        residual > slow_ratio * before;
      stalled = iteration >= best_iteration + (near ? jump_patience : options_.patience) &&
                options_.tangent == GRAINLAW_WANT_TANGENT_EXACT;
      const bool converged = loaded && residual <= tolerance;
      if (converged || (near && (slow || stalled || made == options_.max_iterations))) {
        last_displacement_.keep(displacement - displacement_, target - dofs_.prescribed_at(time_));
        displacement_ = displacement;
        system_ = system;
        time_ = time;
        return {.converged = true, .loose = !converged};
      }
      if (stalled) break;
    }
    return {
        .stalled = far_ >= 0,
        .reason = fmt::format("Newton did not converge: best relative residual {:.1e}, expected "
                              "{:.1e} [-]",
                              best, tolerance)};
  }

  [[nodiscard]] bool crosses_jumps() const {
    return options_.loose_tolerance == 0 && options_.jump_tolerance == 0;
  }

  // Keeps the iterate whose forces differ most from those of the committed stiffness.
  void keep_farthest(const Eigen::VectorXd& displacement, const System& system) {
    const double distance =
        (system.residual - system_.residual + system_.stiffness * (displacement - displacement_))
            .norm();
    if (distance <= far_) return;
    far_ = distance;
    farthest_displacement_ = displacement;
  }

  // Crosses jumps from a stalled attempt and its iterate furthest beyond.
  Attempt cross_jumps(double time, Attempt last, std::vector<double>& residuals, int& crossed) {
    for (int crossing = 0; crossing < most_crossings && last.stalled; ++crossing) {
      const Eigen::VectorXd beyond = farthest_displacement_;
      if (points_.evaluate(beyond, options_.tangent, threads_) != GRAINLAW_OK) return last;
      points_.commit();
      ++crossed;
      displacement_ = beyond;
      system_ = assemble(model_, points_, displacement_, time);
      time_ = time;
      last = equilibrate(time, options_.tolerance, residuals);
    }
    if (last.stalled &&
        points_.evaluate(farthest_displacement_, options_.tangent, threads_) == GRAINLAW_OK) {
      displacement_ = farthest_displacement_;
      system_ = assemble(model_, points_, displacement_, time);
      last.converged = last.loose = true;
    }
    return last;
  }

  // Applies a share of a correction. It is halved while a point refuses or the residual exceeds
  // `before`, if there are halvings; with none at the start it is applied whole.
  Attempt correct(Eigen::VectorXd& displacement, System& system, const Eigen::VectorXd& correction,
                  double& share, double time, double before, int halvings) {
    for (int halving = 0;; ++halving, share *= 0.5) {
      const Eigen::VectorXd tried = displacement + share * correction;
      const grainlaw_status status = points_.evaluate(tried, options_.tangent, threads_);
      const bool reached = status == GRAINLAW_OK;
      if (reached) {
        System found = assemble(model_, points_, tried, time);
        const double residual = dofs_.reduce(found.residual).norm() / found.scale;
        if (halvings == 0 || residual <= before) {
          displacement = tried;
          system = std::move(found);
          return {.converged = true};
        }
      }
      if (halving < halvings) continue;
      if (!reached)
        return {.ratio = points_.step_ratio(), .reason = points_.message(), .status = status};
      return {.reason =
                  fmt::format("{} halvings of a correction did not lower the residual", halvings)};
    }
  }

  // Largest allowed share of a correction, at most 1.
  [[nodiscard]] double bound(const Eigen::VectorXd& correction) const {
    if (options_.largest_correction == 0) return 1;
    return std::min(1.0, options_.largest_correction / points_.largest_change(correction));
  }

  // Adds the load increment: the committed system has the load of its own time.
  void add_load_increment(System& system, double time) const {
    Triplets now, before;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(system.residual.size());
    add_external_force(model_, time_, displacement_, force, &before);
    system.residual -= force;
    add_external_force(model_, time, displacement_, system.residual, &now);
    for (const auto& entry : before) now.emplace_back(entry.row(), entry.col(), -entry.value());
    Eigen::SparseMatrix<double> change(system.stiffness.rows(), system.stiffness.cols());
    change.setFromTriplets(now.begin(), now.end());
    system.stiffness += change;
  }

  [[nodiscard]] double error(const System& system, const Eigen::VectorXd& prescribed) const {
    return dofs_.reduce(system.residual - system.stiffness * prescribed).norm() / system.scale;
  }

  const Model& model_;
  NewtonOptions options_;
  int threads_;
  Dofs dofs_;
  PointField points_;
  Eigen::VectorXd displacement_;         // committed [m]
  Eigen::SparseMatrix<double> elastic_;  // stiffness at F = I
  System system_;                        // at the committed displacement and load
  double time_ = 0;                      // committed
  LastDisplacement last_displacement_;
  Eigen::VectorXd farthest_displacement_;  // iterate of the last attempt furthest from equilibrium
  double far_ = -1;                        // its distance [N/m]; -1: none
};

}  // namespace

std::unique_ptr<Solver> make_newton_solver(const Model& model, const Material& material,
                                           const NewtonOptions& options, int threads) {
  return std::make_unique<NewtonSolver>(model, material, options, threads);
}

}  // namespace verification

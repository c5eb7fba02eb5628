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
#include <optional>
#include <utility>

namespace verification {
namespace {

// An attempt at a load.
struct Iterate {
  double load;
  Eigen::VectorXd displacement;
  System system;
  Eigen::VectorXd driven;  // change of what is prescribed, and what of it corrections left
  Eigen::VectorXd prescribed;
  Eigen::VectorXd again;  // the last displacement once more, as the first guess; or empty
  ElasticShare elastic;
};

class NewtonSolver final : public Solver, private StepMaker {
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
    step_ = {};
    const Parts parts = make_step({.from = time_,
                                   .to = to,
                                   .name = fmt::format("load step {}", number),
                                   .options = march_options(),
                                   .loose_tolerance = options_.loose_tolerance,
                                   .observe_cut = observe_cut_},
                                  *this);
    step_.time = to;
    step_.record = points_.record();
    step_.record.step = number;
    step_.record.effort.iterations = parts.solves;
    step_.record.effort.cuts = parts.cuts;
    step_.record.effort.loose = parts.loose;
    step_.record.effort.crossed = parts.crossed;
    report_supports(model_, to, displacement_, system_.residual, step_);
    return step_;
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
  [[nodiscard]] grainlaw_march_options march_options() const {
    grainlaw_march_options march = grainlaw_march_options_default();
    march.tolerance = options_.tolerance;
    march.max_iterations = options_.max_iterations;
    march.max_cuts = options_.max_cuts;
    const bool exact = options_.tangent == GRAINLAW_WANT_TANGENT_EXACT;
    march.patience = exact ? options_.patience : options_.max_iterations;
    march.largest_correction = options_.largest_correction;
    return march;
  }

  // Extrapolates the committed equilibrium, so that boundary values never jump alone: without a last
  // displacement, prescribed increments enter the right-hand side of the first solve. The part that
  // a bounded correction leaves comes in the next.
  void begin(double load, double length) override {
    step_.attempts.push_back(step_.residuals.size());
    points_.set_time_step(passed_time(length));
    const Eigen::VectorXd driven = dofs_.prescribed_at(load) - dofs_.prescribed_at(time_);
    iterate_.emplace(Iterate{
        load, displacement_, system_, driven, driven, {}, ElasticShare(options_.elastic_share)});
    if (options_.last_displacement_first) iterate_->again = last_displacement_.once_more(driven);
    add_load_increment(iterate_->system, load);
    step_.residuals.push_back(error());
  }

  void solve(Telling& tell) override {
    Iterate& now = *iterate_;
    const bool first = step_.residuals.size() == step_.attempts.back() + 1;
    const bool follows = first && now.again.size() > 0;
    const Eigen::VectorXd correction = follows ? now.again : linear_solve();
    double share = 1;
    if (!correction.allFinite())
      share = tell.share(std::numeric_limits<double>::quiet_NaN());
    else if (!follows)
      share = tell.share(points_.largest_change(correction));
    if (share == 0) return;
    const double before = step_.residuals.back();
    if (!correct(correction, share, before, first ? 0 : options_.line_search, tell)) {
      step_.residuals.push_back(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    now.prescribed *= 1 - share;
    const double residual = error();
    step_.residuals.push_back(residual);
    if (!first && options_.elastic_share > 0) now.elastic.update(before, residual);
    // Halvings, of which the march does not know, leave a rest: not to be accepted.
    if (now.prescribed.isZero(0))
      tell.found(residual, unforeseen());
    else
      tell.found(std::max(residual, 2 * std::max(options_.tolerance, options_.loose_tolerance)));
  }

  void keep() override { farthest_ = iterate_->displacement; }

  void cross(Telling& tell) override {
    if (const grainlaw_status status = evaluate(farthest_); status != GRAINLAW_OK)
      return tell.refused(refusal(status));
    tell.found(error());
  }

  void accept(bool beyond) override {
    points_.commit();
    if (!beyond) {
      step_.balance = std::max(step_.balance, error());
      last_displacement_.keep(iterate_->displacement - displacement_, iterate_->driven);
    }
    displacement_ = std::move(iterate_->displacement);
    system_ = std::move(iterate_->system);
    time_ = iterate_->load;
  }

  void back(bool left) override {
    points_.revert();
    if (left)
      step_.balance =
          std::max(step_.balance, dofs_.reduce(system_.residual).norm() / system_.scale);
  }

  [[nodiscard]] Eigen::VectorXd linear_solve() const {
    const auto measure = points_.cost().measure(Stage::linear_solve);
    const Iterate& now = *iterate_;
    const double elastic = now.elastic.value();
    if (elastic == 0)
      return verification::solve(now.system.stiffness, now.system.residual, dofs_, now.prescribed);
    return verification::solve(now.system.stiffness + elastic * elastic_, now.system.residual,
                               dofs_, now.prescribed);
  }

  // Moves the iterate there where no point refuses.
  grainlaw_status evaluate(const Eigen::VectorXd& displacement) {
    const grainlaw_status status = points_.evaluate(displacement, options_.tangent, threads_);
    if (status != GRAINLAW_OK) return status;
    iterate_->displacement = displacement;
    iterate_->system = assemble(model_, points_, displacement, iterate_->load);
    return status;
  }

  [[nodiscard]] Refusal refusal(grainlaw_status status) const {
    return {.reason = points_.message(), .ratio = points_.step_ratio(), .status = status};
  }

  // Applies a share of a correction. It is halved while a point refuses or the residual exceeds
  // `before`, if there are halvings; with none at the start it is applied whole. False: it was told.
  bool correct(const Eigen::VectorXd& correction, double& share, double before, int halvings,
               Telling& tell) {
    const Eigen::VectorXd from = iterate_->displacement;
    for (int halving = 0;; ++halving, share *= 0.5) {
      const grainlaw_status status = evaluate(from + share * correction);
      const bool reached = status == GRAINLAW_OK;
      if (reached) {
        const System& found = iterate_->system;
        if (halvings == 0 || dofs_.reduce(found.residual).norm() / found.scale <= before)
          return true;
      }
      if (halving < halvings) continue;
      if (!reached)
        tell.refused(refusal(status));
      else
        tell.refused({.reason = fmt::format(
                          "{} halvings of a correction did not lower the residual", halvings)});
      return false;
    }
  }

  // Change of the nodal forces that the committed stiffness does not explain [N/m].
  [[nodiscard]] double unforeseen() const {
    const Iterate& now = *iterate_;
    return (now.system.residual - system_.residual +
            system_.stiffness * (now.displacement - displacement_))
        .norm();
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

  // Relative residual with what is left to prescribe.
  [[nodiscard]] double error() const {
    const System& system = iterate_->system;
    return dofs_.reduce(system.residual - system.stiffness * iterate_->prescribed).norm() /
           system.scale;
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
  LoadStep step_;                   // in progress
  std::optional<Iterate> iterate_;  // of its last attempt
  Eigen::VectorXd farthest_;        // displacement of the iterate that was kept [m]
};

}  // namespace

std::unique_ptr<Solver> make_newton_solver(const Model& model, const Material& material,
                                           const NewtonOptions& options, int threads) {
  return std::make_unique<NewtonSolver>(model, material, options, threads);
}

}  // namespace verification

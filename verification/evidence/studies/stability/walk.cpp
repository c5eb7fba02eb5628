#include "evidence/studies/stability/walk.hpp"

#include "app/cpu_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace verification::stability {
namespace {

constexpr int most_halvings = 10;
constexpr double small_step = 1e-3;        // of the step that failed
constexpr double longest_answer = 20;      // CPU time of one evaluation; more counts as a hang [s]
constexpr double loosest_residual = 1e-2;  // that may pass for an equilibrium [-]
constexpr double no_work = 1e-6;           // of the stored energy: a rotation, by residuals [-]
constexpr double dissipation_rounding = 1e-9;  // of the total work [-]
// What an increment leaves unaccounted counts as a jump beyond this share of the mean work: without
// a jump it is of second order in the increment, and the mean work of first.
constexpr double jump = 0.1;

// The anisotropy of a packing whose contacts all point one way is infinite by its definition.
bool defined(grainlaw_measure what, double value) {
  return std::isfinite(value) ||
         (what == GRAINLAW_ANISOTROPY && value == std::numeric_limits<double>::infinity());
}

// The rotation of the polar decomposition.
template <int D>
TensorOf<D> rotation_of(const TensorOf<D>& f) {
  const Eigen::Matrix<double, D, D> columns = f;
  const Eigen::JacobiSVD<Eigen::Matrix<double, D, D>> parts(
      columns, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return parts.matrixU() * parts.matrixV().transpose();
}

// The logarithm of a rotation: angle times axis, as a skew tensor.
template <int D>
TensorOf<D> spin_of(const TensorOf<D>& q) {
  TensorOf<D> spin = TensorOf<D>::Zero();
  if constexpr (D == 2) {
    spin(1, 0) = std::atan2(q(1, 0), q(0, 0));
  } else {
    const Eigen::AngleAxisd turn{Eigen::Matrix3d(q)};
    for (int k = 0; k < 3; ++k) spin((k + 2) % 3, (k + 1) % 3) = turn.angle() * turn.axis()(k);
  }
  return spin - spin.transpose().eval();
}

template <int D>
class Host {
 public:
  Host(const Material& material, const PathOf<D>& path) : path_(path), state_(material) {
    volume_ = measure_scalar(state_.get(), GRAINLAW_REFERENCE_VOLUME);
    first_stored_ = stored_ = measure_scalar(state_.get(), GRAINLAW_ELASTIC_ENERGY);
  }

  WalkOf<D> go() {
    walk_.increments = static_cast<int>(path_.targets.size());
    if (!step_to(TensorOf<D>::Identity())) {
      walk_.gave_up = "at F = I";
      return walk_;
    }
    walk_.points.push_back({here_, stress_});
    int number = 0;
    for (const TensorOf<D>& target : path_.targets) {
      ++number;
      const Ending ending = reach(target);
      if (ending == Ending::reached) ++walk_.converged;
      if (ending == Ending::lost) ++walk_.zero_stress;
      if (ending == Ending::failed) {
        if (walk_.gave_up.empty())
          walk_.gave_up = fmt::format("{} at increment {}", status_name(last_status_), number);
        if (path_.surrender == Surrender::end_the_path) break;
      } else {
        const bool lost = ending == Ending::lost;
        walk_.points.push_back(
            {target, lost ? TensorOf<D>::Zero().eval() : stress_, in_one_part_, lost});
      }
      if (walk_.cpu > path_.cpu_budget) {
        if (number < walk_.increments)
          walk_.gave_up = fmt::format("the study's {} s of CPU were spent at increment {}",
                                      path_.cpu_budget, number);
        break;
      }
    }
    walk_.stored = stored_ - first_stored_;
    walk_.dissipated = dissipated_;
    const double least = jump * walk_.total_work / static_cast<double>(left_over_.size());
    for (const double energy : left_over_) walk_.released += energy > least ? energy : 0;
    walk_.worked = walk_.total_work > no_work * first_stored_;
    walk_.mean_overlap = measure_scalar(state_.get(), GRAINLAW_MEAN_OVERLAP);
    return std::move(walk_);
  }

 private:
  enum class Ending { reached, lost, failed };

  // From where the point is to the target, in parts when it must be.
  Ending reach(const TensorOf<D>& target) {
    const TensorOf<D> from = here_;
    double done = 0;
    double part = 1;
    int depth = 0;
    in_one_part_ = true;
    while (done < 1) {
      const double share = std::min(done + part, 1.0);
      const TensorOf<D> next = share == 1 ? target : (from + share * (target - from)).eval();
      if (step_to(next)) {
        done = share;
        part = std::min(2 * part, 1 - done);
        depth = std::max(depth - 1, 0);
        continue;
      }
      in_one_part_ = false;
      if (last_status_ == GRAINLAW_CONTACTS_LOST && path_.zero_stress_when_lost)
        return Ending::lost;
      if (depth == most_halvings || walk_.cpu > path_.cpu_budget) return Ending::failed;
      part = 0.5 * (share - done);
      walk_.halvings = std::max(walk_.halvings, ++depth);
    }
    return Ending::reached;
  }

  // One evaluation, and a commit when it succeeds.
  bool step_to(const TensorOf<D>& deformation) {
    const std::vector<std::byte> before = state_.save();
    const double start = cpu_seconds();
    const auto found = evaluate_of<D>(state_, deformation, GRAINLAW_WANT_TANGENT_EXACT);
    const double spent = cpu_seconds() - start;
    count(found, spent);
    if (found.status != GRAINLAW_OK) {
      check_failure(found, before);
      try_small_step(deformation);
      return false;
    }
    check_success(found);
    state_.commit();
    account(found, deformation);
    return true;
  }

  void count(const EvaluationOf<D>& found, double spent) {
    last_status_ = found.status;
    ++walk_.evaluations;
    walk_.cpu += spent;
    walk_.relaxation_steps += static_cast<double>(found.report.relaxation_steps);
    walk_.factorisations += found.report.factorisations;
    if (found.status != GRAINLAW_OK) ++walk_.failures[found.status];
    if (spent > longest_answer) violate(fmt::format("one evaluation took {:.0f} s", spent));
  }

  void check_success(const EvaluationOf<D>& found) {
    const grainlaw_report& report = found.report;
    if (!found.stress.allFinite()) violate("P is not finite");
    if (!found.tangent.allFinite()) violate("the tangent is not finite");
    if (!std::isfinite(report.residual)) violate("the residual is not finite");
    if (report.residual > loosest_residual)
      violate(fmt::format("success with a residual of {:.3g}", report.residual));
    if (report.step_ratio != 1) violate("step_ratio is not 1 after success");
#define GRAINLAW_X(name, value, count, text)         \
  for (const double x : measure(state_.get(), name)) \
    if (!defined(name, x)) violate(#name " is not finite");
    GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
    walk_.worst_residual = std::max(walk_.worst_residual, report.residual);
    if (report.subincrements > 1) {
      walk_.subincrements += report.subincrements;
      in_one_part_ = false;
    }
    if (report.history_advanced != 0) ++walk_.advancing;
    if (report.tangent_exact == 0) ++walk_.inexact;
  }

  void check_failure(const EvaluationOf<D>& found, const std::vector<std::byte>& before) {
    if (state_.save() != before) violate("a failed evaluation changed the committed state");
    if (!found.stress.isZero(0) || !found.tangent.isZero(0))
      violate("a failed evaluation wrote P or the tangent");
    const double ratio = found.report.step_ratio;
    if (!(ratio > 0 && ratio < 1)) violate(fmt::format("step_ratio is {} after a failure", ratio));
    if (grainlaw_commit(state_.get()) != GRAINLAW_NO_TRIAL)
      violate("a failed evaluation left a trial to commit");
  }

  // After a failure the point must stand where it was, and a small step may still succeed.
  void try_small_step(const TensorOf<D>& failed) {
    if (evaluate_of<D>(state_, here_, 0).status != GRAINLAW_OK)
      violate("after a failure the committed F itself finds no equilibrium");
    ++walk_.small_steps;
    const TensorOf<D> near = here_ + small_step * (failed - here_);
    if (evaluate_of<D>(state_, near, 0).status == GRAINLAW_OK) ++walk_.small_steps_done;
    state_.revert();
  }

  void account(const EvaluationOf<D>& found, const TensorOf<D>& deformation) {
    // A trapezoid would not know of the rotation of the increment. It does work on the moments of
    // drag, of which P F^T is skew.
    const TensorOf<D> turn = rotation_of<D>(deformation * here_.inverse());
    const TensorOf<D> stress = turn.transpose() * found.stress;
    const TensorOf<D> stretched = turn.transpose() * deformation;
    const TensorOf<D> sum = stress + stress_;
    const TensorOf<D> kirchhoff = stress * stretched.transpose() + stress_ * here_.transpose();
    const double work = 0.5 * volume_ *
                        (sum.cwiseProduct(stretched - here_).sum() +
                         kirchhoff.cwiseProduct(spin_of<D>(turn)).sum());
    walk_.work += work;
    walk_.total_work += std::abs(work);
    const double stored = measure_scalar(state_.get(), GRAINLAW_ELASTIC_ENERGY);
    const double dissipated = measure_scalar(state_.get(), GRAINLAW_DISSIPATED_ENERGY);
    const double increment = dissipated - dissipated_;
    walk_.dragged += found.report.viscous_work;
    left_over_.push_back(work - (stored - stored_) - increment - found.report.viscous_work);
    stored_ = stored;
    walk_.least_dissipation = std::min(walk_.least_dissipation, increment);
    if (increment < -dissipation_rounding * (walk_.total_work + stored_))
      violate(fmt::format("friction gave {:.3g} J back", -increment));
    dissipated_ = dissipated;
    here_ = deformation;
    stress_ = found.stress;
  }

  void violate(const std::string& what) {
    if (walk_.violation.empty()) walk_.violation = what;
  }

  const PathOf<D>& path_;
  State state_;
  double volume_ = 0;              // at F = I [m3]
  double first_stored_ = 0;        // [J]
  double stored_ = 0;              // [J]
  double dissipated_ = 0;          // [J]
  std::vector<double> left_over_;  // of the work of every step: neither stored nor dissipated [J]
  TensorOf<D> here_ = TensorOf<D>::Identity();
  TensorOf<D> stress_ = TensorOf<D>::Zero();
  grainlaw_status last_status_ = GRAINLAW_OK;
  bool in_one_part_ = true;
  WalkOf<D> walk_;
};

}  // namespace

template <int D>
WalkOf<D> walk(const Material& material, const PathOf<D>& path) {
  return Host<D>(material, path).go();
}

template WalkOf<2> walk(const Material&, const PathOf<2>&);
template WalkOf<3> walk(const Material&, const PathOf<3>&);

std::string status_name(grainlaw_status status) {
  constexpr std::size_t prefix = sizeof "GRAINLAW_" - 1;
#define GRAINLAW_X(name, value, text) \
  if (status == name) return std::string(#name).substr(prefix);
  GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  return "?";
}

}  // namespace verification::stability

#include "points/stress_path.hpp"

#include "base/error.hpp"
#include "equilibrium/request.hpp"
#include "math/inner_product.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace grainlaw::core {

namespace {

constexpr double loose = 1e-5, tight = 2e-9;  // error / norm of what is wanted [-]
constexpr double largest_strain = 0.02;       // of one iteration [-]
// Rest of the way that the last step takes with it, over a step.
constexpr double rest = 0.1;
constexpr double least_size = 1e-2;  // of the stress that a step is a share of, over the goal
// How long a part lasts; after 3 memories, drag holds up to 15 % more.
constexpr double memories = 12;
constexpr double all_memories = 36;  // after which no drag is left
constexpr int most_holds = 30;
constexpr double settled = 1e-7;  // drag / mean contact force [-]

grainlaw_march_options options_of(double tolerance) {
  grainlaw_march_options options = default_march_options();
  options.tolerance = tolerance;
  options.largest_correction = 0;
  return options;
}

template <int D>
Eigen::VectorXd components(const Directions<D>& directions, const Tensor<D>& stress) {
  Eigen::VectorXd value(static_cast<Eigen::Index>(directions.size()));
  for (std::size_t m = 0; m < directions.size(); ++m)
    value(static_cast<Eigen::Index>(m)) = inner<D>(stress, directions[m]);
  return value;
}

template <int D>
Tensor<D> cauchy_stress(const Tensor<D>& P, const Tensor<D>& F) {
  Tensor<D> sigma = product<D>(P, transpose<D>(F));
  const double det = determinant<D>(F);
  for (double& component : sigma) component /= det;
  return sigma;
}

}  // namespace

template <int D>
Directions<D> all_directions() {
  Directions<D> directions;
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = i; j < D; ++j) {
      Tensor<D> direction{};
      direction[D * i + j] = direction[D * j + i] = i == j ? 1 : std::sqrt(0.5);
      directions.push_back(direction);
    }
  }
  return directions;
}

template <int D>
Directions<D> directions_of_traction(const Vec<D>& normal) {
  // The normal, then what Gram and Schmidt leave of the axes.
  std::vector<Vec<D>> axes{normal};
  std::array<std::size_t, D> order{};
  for (std::size_t k = 0; k < D; ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(normal[a]) < std::abs(normal[b]);
  });
  for (std::size_t k = 0; k + 1 < D; ++k) {
    Vec<D> axis{};
    axis[order[k]] = 1;
    for (const Vec<D>& other : axes) {
      const double along = other[order[k]];
      for (std::size_t i = 0; i < D; ++i) axis[i] -= along * other[i];
    }
    const double size = length<D>(axis);
    for (double& component : axis) component /= size;
    axes.push_back(axis);
  }
  Directions<D> directions;
  for (std::size_t k = 0; k < D; ++k) {
    Tensor<D> direction{};
    const double share = k == 0 ? 0.5 : std::sqrt(0.5);
    for (std::size_t i = 0; i < D; ++i)
      for (std::size_t j = 0; j < D; ++j)
        direction[D * i + j] = share * (normal[i] * axes[k][j] + axes[k][i] * normal[j]);
    directions.push_back(direction);
  }
  return directions;
}

template <int D>
StressPath<D>::StressPath(State<D>& state, double largest_step)
    : state_(state), largest_step_(largest_step), start_(state.committed().deformation) {
  state_.revert();
  Attempt attempt;
  if (!evaluate(identity<D>(), all_memories, attempt))
    throw Error(attempt.status, fmt::format("at its start: {}", attempt.reason));
  state_.revert();
  at_ = attempt.end;
  at_.sigma = carried_ = cauchy_stress<D>(state_.committed().stress, start_);
}

template <int D>
Tensor<D> StressPath<D>::deformation(const Tensor<D>& stretch) const {
  return product<D>(stretch, start_);
}

// d(sigma) = (dP F^T + P dF^T) / det F - sigma tr(F^-1 dF), along dF = B F of the start.
template <int D>
typename StressPath<D>::Linear StressPath<D>::linearise(const Directions<D>& directions,
                                                        const Point& point) const {
  const auto n = static_cast<Eigen::Index>(directions.size());
  Linear found{components<D>(directions, point.sigma), Eigen::MatrixXd(n, n)};
  const Tensor<D> F = deformation(point.stretch);
  const Tensor<D> back = inverse<D>(F);
  const double det = determinant<D>(F);
  for (Eigen::Index c = 0; c < n; ++c) {
    const Tensor<D> dF = product<D>(directions[static_cast<std::size_t>(c)], start_);
    Tensor<D> dP{};
    for (std::size_t k = 0; k < squared<D>; ++k)
      for (std::size_t l = 0; l < squared<D>; ++l)
        dP[k] += point.answer.tangent[k * squared<D> + l] * dF[l];
    const double growth = trace<D>(product<D>(back, dF));
    Tensor<D> change = product<D>(dP, transpose<D>(F));
    const Tensor<D> turned = product<D>(point.answer.stress, transpose<D>(dF));
    for (std::size_t k = 0; k < squared<D>; ++k)
      change[k] = (change[k] + turned[k]) / det - point.sigma[k] * growth;
    found.slope.col(c) = components<D>(directions, change);
  }
  return found;
}

template <int D>
bool StressPath<D>::evaluate(const Tensor<D>& stretch, double duration, Attempt& attempt) {
  const Tensor<D> F = deformation(stretch);
  grainlaw_report report{};
  Point& end = attempt.end;
  end.stretch = stretch;
  const bool drag = state_.material().solver.viscosity.number > 0;
  attempt.status = determinant<D>(F) > 0 ? state_.follow(F, drag ? duration : by_strain,
                                                         TangentKind::exact, end.answer, report)
                                         : GRAINLAW_INVERTED;
  attempt.ratio = report.step_ratio;
  if (attempt.status != GRAINLAW_OK) {
    attempt.reason =
        report.message[0] != '\0' ? report.message : grainlaw_status_text(attempt.status);
    return false;
  }
  end.sigma = cauchy_stress<D>(end.answer.stress, F);
  end.unbalanced = report.unbalanced;
  return true;
}

// One iteration of Newton's method, from the committed point or the last iterate.
template <int D>
Told StressPath<D>::iterate(const Directions<D>& directions, const Eigen::VectorXd& goal,
                            double duration, Attempt& attempt) {
  const Linear now = linearise(directions, attempt.end);
  const Eigen::VectorXd change = now.slope.fullPivLu().solve(goal - now.value);
  if (!(change.norm() <= largest_strain)) {
    attempt.reason = "the packing yields";
    return {.reason = attempt.reason.c_str()};
  }
  Tensor<D> stretch = attempt.end.stretch;
  for (std::size_t m = 0; m < directions.size(); ++m)
    for (std::size_t k = 0; k < squared<D>; ++k)
      stretch[k] += change(static_cast<Eigen::Index>(m)) * directions[m][k];
  if (!evaluate(stretch, duration, attempt))
    return {.step_ratio = attempt.ratio, .reason = attempt.reason.c_str()};
  const Linear first = linearise(directions, at_);
  Tensor<D> strain = stretch;
  for (std::size_t k = 0; k < squared<D>; ++k) strain[k] -= at_.stretch[k];
  const Eigen::VectorXd value = components<D>(directions, attempt.end.sigma);
  const Eigen::VectorXd foreseen = first.value + first.slope * components<D>(directions, strain);
  return {.found = true,
          .residual = (goal - value).norm() / goal.norm(),
          .unforeseen = (value - foreseen).norm()};
}

template <int D>
void StressPath<D>::march(const Directions<D>& directions, const Goal& goal, double from, double to,
                          double tolerance, double duration) {
  March march(options_of(tolerance));
  march.begin(from, to);
  Attempt attempt;
  Tensor<D> farthest{};
  int crossed = 0;
  for (;;) {
    const grainlaw_action now = march.next();
    if (march.part().loose > 0) {
      state_.revert();
      throw Error(GRAINLAW_NOT_CONVERGED, "the packing flows");
    }
    switch (now) {
      case GRAINLAW_SOLVE:
        if (march.begins_attempt()) {
          attempt = {};
          attempt.end = at_;
        }
        march.tell(iterate(directions, goal(march.part().load), duration, attempt));
        if (march.part().keep) farthest = attempt.end.stretch;
        break;
      case GRAINLAW_CROSS: {
        const bool found = evaluate(farthest, duration, attempt);
        march.tell({.found = found, .reason = attempt.reason.c_str()});
        break;
      }
      case GRAINLAW_ACCEPT:
        state_.commit();
        at_ = attempt.end;
        if (march.part().crossed == crossed) carried_ = at_.sigma;
        crossed = march.part().crossed;
        break;
      case GRAINLAW_BACK:
        state_.revert();
        break;
      case GRAINLAW_DONE:
        return;
      default:
        state_.revert();
        throw Error(attempt.status == GRAINLAW_OK ? GRAINLAW_NOT_CONVERGED : attempt.status,
                    attempt.reason.empty() ? "Newton's method does not converge" : attempt.reason);
    }
  }
}

template <int D>
void StressPath<D>::lead(const Directions<D>& directions, const Tensor<D>& wanted) {
  const Eigen::VectorXd from = components<D>(directions, at_.sigma);
  const Eigen::VectorXd end = components<D>(directions, wanted), way = end - from;
  if (way.norm() <= loose * end.norm()) return;
  const Goal goal = [&](double done) -> Eigen::VectorXd { return from + done * way; };
  for (double done = 0, next = 0; done < 1; done = next) {
    const double size = std::max(goal(done).norm(), least_size * end.norm());
    const double step = largest_step_ * size / way.norm();
    next = done + step < 1 - rest * step ? done + step : 1;
    march(directions, goal, done, next, loose, memories);
  }
}

template <int D>
void StressPath<D>::settle(const Directions<D>& directions, const Tensor<D>& wanted) {
  const Eigen::VectorXd end = components<D>(directions, wanted);
  const Goal goal = [&](double) { return end; };
  const bool drag = state_.material().solver.viscosity.number > 0;
  const auto meet = [&](double duration) { march(directions, goal, 1, 1, tight, duration); };
  meet(memories);
  for (int hold = 0; drag && hold < most_holds && at_.unbalanced > settled; ++hold) meet(memories);
  if (drag) meet(all_memories);
}

#define GRAINLAW_FOR(D)                                            \
  template Directions<D> all_directions<D>();                      \
  template Directions<D> directions_of_traction<D>(const Vec<D>&); \
  template class StressPath<D>;
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

// Methods, paths and runs of `grainlaw_evidence error`.

#include "evidence/studies/clock.hpp"
#include "evidence/studies/error/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace verification::error_study {
namespace {

// eps_a of the servo over the tolerance of the particles' residuals, see servo.cpp.
constexpr double servo_tolerance = 1e-3;

}  // namespace

MaterialSource with_method(const StudyOptions& options, const Method& method, double tolerance,
                           int repeat) {
  MaterialSource source = options.material(tolerance, repeat);
  change(source, "boundary", "type", std::string(method.boundary_type));
  change(source, "boundary", "method", std::string(method.boundary_method));
  change(source, "solver", "method", std::string(method.solver_method));
  if (std::string(method.boundary_method) == "servo")
    source.changes["boundary"].as_table()->insert(
        "servo", toml::table{{"tolerance", tolerance * servo_tolerance}, {"inheritance", 1.0}});
  return source;
}

Tensor Path::at(double t) const {
  const double position = t * static_cast<double>(points.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(position), points.size() - 2);
  return points[k] + (position - static_cast<double>(k)) * (points[k + 1] - points[k]);
}

Path Path::until(double end) const {
  Path part = *this;
  part.points.resize(static_cast<std::size_t>(std::lround(end / step)) + 1);
  return part;
}

Path drained_path(const StudyOptions& options) {
  constexpr double end = 0.015;
  Path path{"drained", {Tensor::Identity()}};
  const Material material = make_material(with_method(options, direct, reference_tolerance));
  PointDriver driver(material, {});
  driver.run(
      drained_segment(-end, drained_pressure, static_cast<int>(std::lround(end / path.step))),
      [&](const PointStep& step) { path.points.push_back(step.record.deformation); });
  return path;
}

Path shear_path() {
  Path path{"shear", {}};
  for (int k = 0; k <= static_cast<int>(std::lround(path_end / path.step)); ++k) {
    path.points.emplace_back(Tensor::Identity());
    path.points.back()(0, 1) = k * path.step;
  }
  return path;
}

Replay replay(const Material& material, const Path& path, int increments) {
  Replay run;
  State state(material);
  for (int k = 1; k <= increments; ++k) {
    const Tensor deformation = path.at(static_cast<double>(k) / increments);
    const double start = cpu_milliseconds();
    const Evaluation evaluation = evaluate(state, deformation, 0);
    run.cpu += cpu_milliseconds() - start;
    run.relaxation_steps += static_cast<double>(evaluation.report.relaxation_steps);
    if (evaluation.status != GRAINLAW_OK) {
      run.failure =
          fmt::format("increment {} of {}: {}", k, increments,
                      evaluation.status == GRAINLAW_NOT_CONVERGED ? "no equilibrium" : "refused");
      return run;
    }
    state.commit();
    run.stress.push_back(evaluation.stress);
  }
  return run;
}

double path_error(const Replay& run, const Replay& reference) {
  if (!run.failure.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t ratio = reference.stress.size() / run.stress.size();
  const std::size_t every = std::max<std::size_t>(1, run.stress.size() / 10);
  double worst = 0;
  for (std::size_t k = every; k <= run.stress.size(); k += every) {
    const Tensor& exact = reference.stress[k * ratio - 1];
    worst = std::max(worst, (run.stress[k - 1] - exact).norm() / exact.norm());
  }
  return worst;
}

std::vector<Start> exact_starts(const Material& material, const Path& path) {
  std::vector<Start> starts;
  State state(material);
  for (std::size_t k = 1; k < path.points.size(); ++k) {
    Start start{state.save(), path.points[k]};
    check(evaluate(state, start.deformation, 0).status, "leading the path");
    state.commit();
    starts.push_back(std::move(start));
  }
  return starts;
}

State state_at(const Material& material, const Start& start) {
  State state(material);
  state.load(start.bytes);
  return state;
}

}  // namespace verification::error_study

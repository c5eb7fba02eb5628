// `grainlaw_evidence drag`: the law without jumps (solver.viscous_time) beside equilibrium, along
// drained compression of several packings to 10 %.

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/cpu_time.hpp"
#include "app/csv.hpp"
#include "app/jobs.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

namespace verification {
namespace {

struct Setting {
  double time;  // 0: equilibrium
  double inertia = 1;
  int steps = 1;
  [[nodiscard]] std::string name() const {
    if (time == 0) return "equilibrium";
    std::string text = fmt::format("time {:g}", time);
    if (inertia != 1) text += fmt::format(", inertia {:g}", inertia);
    if (steps != 1) text += fmt::format(", {} steps", steps);
    return text;
  }
};

constexpr std::array<Setting, 7> settings{{{0}, {30}, {100}, {300}, {1000}, {100, 0}, {100, 1, 3}}};

constexpr double host_tolerance = 1e-8;  // of the lateral stress
constexpr int most_iterations = 12;

// What one packing gave along its path.
struct Path {
  std::vector<double> strain{0}, ratio{1};  // axial strain, axial over lateral stress
  std::vector<double> iterations;           // of steps that converged
  std::vector<double> unbalanced;
  double failed = 0;  // steps that found no equilibrium, or lateral stress did not converge
  double advanced = 0, factorisations = 0, evaluations = 0, milliseconds = 0;
  std::vector<double> tangent_error;  // by increments after the peak
  double jumps = 0, lines = 0;
  double same = 0, starts = 0;  // the same P from a cold and a warm start
};

Tensor deformation_at(double axial_strain, double lateral) {
  Tensor F = Tensor::Zero();
  F(0, 0) = lateral;
  F(1, 1) = 1 - axial_strain;
  return F;
}

// The best of several stencils; none where an evaluation failed.
std::optional<double> tangent_error(State& state, const Tensor& F) {
  const Evaluation centre = evaluate(state, F, GRAINLAW_WANT_TANGENT_EXACT);
  if (centre.status != GRAINLAW_OK) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    Tangent differences;
    for (int k = 0; k < 4; ++k) {
      Vector4 change = Vector4::Zero();
      for (const double sign : {1.0, -1.0}) {
        Tensor moved = F;
        moved(k / 2, k % 2) += sign * step;
        const Evaluation there = evaluate(state, moved, 0);
        if (there.status != GRAINLAW_OK) return std::nullopt;
        change += sign / (2 * step) * to_vector(there.stress);
      }
      differences.col(k) = change;
    }
    least = std::min(least, (centre.tangent - differences).norm() / differences.norm());
  }
  return least;
}

// Along a fine line through the next increment and half as much beyond: changes of P from point to point
// that are far more than its others.
double jumps_on_line(State& state, const Tensor& from, const Tensor& to, double pressure) {
  constexpr int points = 100;
  constexpr double beyond = 1.5, far_more = 20, least = 1e-3;
  std::vector<double> changes;
  Tensor last = Tensor::Zero();
  bool has_last = false;
  for (int k = 0; k <= points; ++k) {
    const Tensor F = from + beyond * k / points * (to - from);
    const Evaluation at = evaluate(state, F, 0);
    if (at.status != GRAINLAW_OK) {
      has_last = false;
      changes.push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    if (has_last) changes.push_back((at.stress - last).norm());
    last = at.stress;
    has_last = true;
  }
  std::sort(changes.begin(), changes.end());
  const double bound = std::max(far_more * changes[changes.size() / 2], least * pressure);
  return static_cast<double>(changes.end() -
                             std::upper_bound(changes.begin(), changes.end(), bound));
}

void look_closer(Path& path, const State& committed, const Tensor& from, const Tensor& to) {
  State state(committed);
  if (const auto error = tangent_error(state, to)) path.tangent_error.push_back(*error);
  path.jumps += jumps_on_line(state, from, to, -drained_pressure);
  ++path.lines;
  State cold(committed);
  const Evaluation alone = evaluate(cold, to, 0);
  evaluate(state, from + 0.7 * (to - from), 0);
  const Evaluation after = evaluate(state, to, 0);
  if (alone.status != GRAINLAW_OK || after.status != GRAINLAW_OK) return;
  ++path.starts;
  if ((alone.stress - after.stress).norm() < 1e-8 * alone.stress.norm()) ++path.same;
}

Path run_path(const StudyOptions& options, const Setting& setting, long seed, int steps) {
  MaterialSource source;
  source.file = options.scene("pack400.toml");
  source.base = source.file.parent_path();
  change(source, "packing", "seed", seed);
  change(source, "solver", "tolerance", 1e-10);
  change(source, "solver", "start", std::string("trial"));
  if (setting.time > 0) {
    change(source, "solver", "viscous_time", setting.time);
    change(source, "solver", "viscous_inertia", setting.inertia);
    change(source, "solver", "viscous_steps", static_cast<long>(setting.steps));
  }
  const Material material = make_material(source);
  State state(material);
  const double pressure = -evaluate(state, Tensor::Identity(), 0).stress(0, 0);
  Path path;
  double lateral = 1;
  for (int n = 1; n <= steps; ++n) {
    const double strain = 0.1 * n / steps;
    const Tensor from = deformation_at(strain - 0.1 / steps, lateral);
    Evaluation at;
    int iteration = 0;
    bool converged = false;
    for (; iteration <= most_iterations && !converged; ++iteration) {
      const double start = cpu_seconds();
      at = evaluate(state, deformation_at(strain, lateral), GRAINLAW_WANT_TANGENT_EXACT);
      path.milliseconds += 1e3 * (cpu_seconds() - start);
      ++path.evaluations;
      path.factorisations += at.report.factorisations;
      if (at.status != GRAINLAW_OK) break;
      const double missing = at.stress(0, 0) + pressure;
      converged = std::abs(missing) < host_tolerance * pressure;
      if (!converged) lateral -= missing / at.tangent(0, 0);
    }
    if (at.status != GRAINLAW_OK) {
      path.failed += steps - n + 1;
      break;
    }
    path.advanced += at.report.history_advanced;
    if (converged) {
      path.iterations.push_back(iteration - 1);
    } else {
      ++path.failed;
    }
    path.strain.push_back(strain);
    path.ratio.push_back(at.stress(1, 1) * (1 - strain) / (at.stress(0, 0) * lateral));
    path.unbalanced.push_back(at.report.unbalanced);
    if (strain > 0.025 && n % (steps / 20) == 0) {
      look_closer(path, state, from, deformation_at(strain, lateral));
      (void)evaluate(state, deformation_at(strain, lateral), 0);
    }
    state.commit();
  }
  return path;
}

double mean_between(const Path& path, double low, double high) {
  std::vector<double> values;
  for (std::size_t k = 0; k < path.strain.size(); ++k) {
    if (path.strain[k] >= low && path.strain[k] <= high) values.push_back(path.ratio[k]);
  }
  return average(values);
}

void run_study(const StudyOptions& options, int packings, int steps, int threads) {
  Table table(fmt::format("drained compression of {} packings to 10 % in {} steps; host Newton to "
                          "{:g}; lines, tangents and starts beyond 2.5 %",
                          packings, steps, host_tolerance),
              {"setting", "failed[-]", "advanced[-]", "iterations_95[-]", "factorisations[-]",
               "ms[-]", "bias_to_1[%]", "peak[-]", "mean_3_6[-]", "mean_6_10[-]", "s.e._6_10[-]",
               "unbalanced[%]", "tangent_median[-]", "tangent_above_1e-6[-]", "tangents[-]",
               "jumps[-]", "lines[-]", "same_start[-]", "starts[-]"});
  std::vector<Path> equilibrium;
  for (const Setting& setting : settings) {
    std::vector<Path> paths(static_cast<std::size_t>(packings));
    run_jobs(paths.size(), threads, [&](std::size_t k) {
      paths[k] = run_path(options, setting, static_cast<long>(k) + 1, steps);
      tell(fmt::format("{}, packing {}\n", setting.name(), k + 1));
    });
    if (setting.time == 0) equilibrium = paths;
    Path all;
    std::vector<double> bias, peak, middle, late;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const Path& path = paths[k];
      all.failed += path.failed;
      all.advanced += path.advanced;
      all.factorisations += path.factorisations;
      all.evaluations += path.evaluations;
      all.milliseconds += path.milliseconds;
      all.jumps += path.jumps;
      all.lines += path.lines;
      all.same += path.same;
      all.starts += path.starts;
      const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
        to.insert(to.end(), from.begin(), from.end());
      };
      append(all.iterations, path.iterations);
      append(all.unbalanced, path.unbalanced);
      append(all.tangent_error, path.tangent_error);
      bias.push_back(
          100 * (mean_between(path, 1e-9, 0.01) / mean_between(equilibrium[k], 1e-9, 0.01) - 1));
      peak.push_back(largest(path.ratio));
      middle.push_back(mean_between(path, 0.03, 0.06));
      late.push_back(mean_between(path, 0.06, 0.1));
    }
    std::sort(all.iterations.begin(), all.iterations.end());
    const auto above = std::count_if(all.tangent_error.begin(), all.tangent_error.end(),
                                     [](double error) { return error > 1e-6; });
    table.row({setting.name(), all.failed, all.advanced,
               all.iterations.empty() ? 0.0 : all.iterations[all.iterations.size() * 95 / 100],
               all.factorisations / all.evaluations, all.milliseconds / all.evaluations,
               average(bias), average(peak), average(middle), average(late), standard_error(late),
               100 * average(all.unbalanced), median(all.tangent_error), static_cast<double>(above),
               static_cast<double>(all.tangent_error.size()), all.jumps, all.lines, all.same,
               all.starts});
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_drag.csv");
}

}  // namespace

void add_drag_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    int packings = 5;
    int steps = 100;
    int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("drag", "the law without jumps beside equilibrium");
  command->add_option("--packings", arguments->packings, "seeds 1 to this number [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--steps", arguments->steps, "increments to 10 % axial strain [-]")
      ->check(at_least(20))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "packings run at once [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([arguments, options] {
    run_study(*options, arguments->packings, arguments->steps, arguments->threads);
  });
}

}  // namespace verification

// `grainlaw_evidence timing`: CPU time of one evaluation along the drained path.

#include "evidence/studies/clock.hpp"
#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace verification {
namespace {

struct Cost {
  double strain;
  double plain;       // without a tangent [ms]
  double with_exact;  // with the exact tangent [ms]
  grainlaw_report report;
  double loose;       // with the exact tangent, by a material with a loose tolerance [ms]
  double difference;  // of its P, relative [-]
  double residual;    // it ended at [-]
};

constexpr double loose_tolerance = 1e-2;

// A point in the same state, of a material that differs in its solver alone.
State point_of(const Material& material, const State& state) {
  State point(material);
  point.load(state.save());
  return point;
}

void summarise(Table& table, const std::vector<Cost>& costs, double limit) {
  std::vector<double> plain, exact, loose, difference, steps, factorisations;
  for (const Cost& cost : costs) {
    if (cost.strain > limit * (1 + 1e-9)) continue;
    plain.push_back(cost.plain);
    exact.push_back(cost.with_exact);
    loose.push_back(cost.loose);
    difference.push_back(cost.difference);
    steps.push_back(static_cast<double>(cost.report.relaxation_steps));
    factorisations.push_back(cost.report.factorisations);
  }
  const std::string range = fmt::format("up to {:g} %", 100 * limit);
  table.row({range, "mean", average(plain), average(exact), average(loose), average(difference),
             average(steps), average(factorisations)});
  table.row({range, "median", median(plain), median(exact), median(loose), median(difference),
             median(steps), median(factorisations)});
}

void run_study(const StudyOptions& options, double tolerance, double axial) {
  constexpr double increment = 0.001;
  constexpr double before_peak = 0.015;
  const Material material = make_material(options.material(tolerance));
  MaterialSource bounded = options.material(tolerance);
  change(bounded, "solver", "loose_tolerance", loose_tolerance);
  const Material loose_material = make_material(bounded);
  std::vector<Cost> costs;
  Progress progress("timing");
  PointDriver driver(material, study_options());
  const int steps = static_cast<int>(axial / increment + 0.5);
  driver.run(drained_segment(-axial, drained_pressure, steps), [&](const PointStep& step) {
    progress.update(step.fraction, "");
    const Tensor& deformation = step.record.deformation;
    const auto [plain, cpu] = time_evaluation(step.state, deformation, 0);
    const double cpu_exact =
        time_evaluation(step.state, deformation, GRAINLAW_WANT_TANGENT_EXACT).cpu;
    const State point = point_of(loose_material, step.state);
    const auto [loose, cpu_loose] =
        time_evaluation(point, deformation, GRAINLAW_WANT_TANGENT_EXACT);
    costs.push_back({step.record.axial_strain(), cpu, cpu_exact, plain.report, cpu_loose,
                     (loose.stress - plain.stress).norm() / plain.stress.norm(),
                     loose.report.residual});
  });
  Table each(
      "", {"axial_strain[-]", "cpu[ms]", "cpu_with_tangent[ms]", "cpu_loose[ms]",
           "difference_loose[-]", "residual_loose[-]", "relaxation_steps[-]", "factorisations[-]"});
  for (const Cost& cost : costs)
    each.row({cost.strain, cost.plain, cost.with_exact, cost.loose, cost.difference, cost.residual,
              static_cast<double>(cost.report.relaxation_steps),
              static_cast<double>(cost.report.factorisations)});
  each.write(std::filesystem::path(options.output) / "study_timing.csv");
  Table table(
      fmt::format("one evaluation of a 0.1 % increment of the drained path, tolerance {:.0e} "
                  "[-], one thread; steps and factorisations without tangent; loose: with "
                  "loose_tolerance {:.0e} [-], with tangent, and how far its P is off",
                  tolerance, loose_tolerance),
      {"axial strain", "statistic", "cpu[ms]", "cpu_with_tangent[ms]", "cpu_loose[ms]",
       "difference_loose[-]", "relaxation_steps[-]", "factorisations[-]"});
  summarise(table, costs, before_peak);
  if (axial > before_peak) summarise(table, costs, axial);
  table.print();
}

}  // namespace

void add_timing_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    double tolerance = 1e-6;
    double axial = 0.1;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("timing", "CPU time per evaluation");
  command->add_option("--tolerance", arguments->tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command->add_option("--axial", arguments->axial, "axial strain of the path [-]")
      ->capture_default_str();
  command->callback(
      [arguments, options] { run_study(*options, arguments->tolerance, arguments->axial); });
}

}  // namespace verification

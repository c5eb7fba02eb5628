// `grainlaw_evidence servo`: the published servo on a frame against direct relaxation.

#include "evidence/studies/study.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace verification {
namespace {

struct Variant {
  const char* name;
  const char* boundary_method;
  const char* solver_method;
  double inheritance;  // of the servo's prediction, n_f [-]
};

// All on the same frame. The servo is the published one, with and without prediction; "direct"
// relaxes the frame with the particles: by the servo's own relaxation, by the viscous one with the
// history advancing too, and by the default with friction as a function of F.
constexpr std::array<Variant, 5> variants{
    {{"servo, n_f = 1", "servo", "published", 1},
     {"servo, n_f = 0", "servo", "published", 0},
     {"direct, published relaxation", "direct", "published", 1},
     {"direct, advancing history", "direct", "advancing", 1},
     {"direct", "direct", "direct", 1}}};

// eps_a over the tolerance of the particles' residuals: the servo's r_a is relative to M R / dt^2,
// here about a thousand mean contact forces, so that both stop at the same unbalanced force.
constexpr double servo_tolerance = 1e-3;

struct ShearRun {
  std::vector<Tensor> stress;  // P at the common strains [Pa]
  double relaxation_steps = 0;
  double servo_corrections = 0;
  std::string failure;
};

ShearRun shear_frame(const StudyOptions& options, const Variant& variant, double shear,
                     double increment, double spacing, double tolerance) {
  ShearRun run;
  MaterialSource source = options.material(tolerance);
  change(source, "boundary", "type", std::string("frame-p"));
  change(source, "boundary", "method", std::string(variant.boundary_method));
  change(source, "solver", "method", std::string(variant.solver_method));
  if (std::string(variant.boundary_method) == "servo")
    source.changes["boundary"].as_table()->insert(
        "servo", toml::table{{"tolerance", tolerance * servo_tolerance},
                             {"inheritance", variant.inheritance}});
  try {
    const Material material = make_material(source);
    PointDriver driver(material, {});
    Progress progress(fmt::format("{}, increments of {:g} %", variant.name, 100 * increment));
    const int steps = static_cast<int>(std::lround(shear / increment));
    const int every = std::max(1, static_cast<int>(std::lround(spacing / increment)));
    driver.run(shear_segment(shear, steps), [&](const PointStep& step) {
      progress.update(step.fraction, "");
      run.relaxation_steps += static_cast<double>(step.record.effort.relaxation_steps);
      run.servo_corrections += static_cast<double>(step.record.effort.servo_corrections);
      if (step.record.step % every == 0) run.stress.push_back(step.record.stress);
    });
  } catch (const ComputationError& error) {
    run.failure = error.what();
  }
  return run;
}

// Largest |P_a - P_b| / |P_b| over the strains that both reached.
double distance(const ShearRun& a, const ShearRun& b) {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < std::min(a.stress.size(), b.stress.size()); ++k)
    largest = std::fmax(largest, (a.stress[k] - b.stress[k]).norm() / b.stress[k].norm());
  return largest;
}

void run_study(const StudyOptions& options, double shear, double tolerance) {
  constexpr double spacing = 0.005;  // the largest increment
  Table table(
      fmt::format("frame-p sheared to F12 = {:g} [-], tolerance {:.0e} [-]; distances are the "
                  "largest |P - P_servo| / |P_servo| at multiples of 0.5 %",
                  shear, tolerance),
      {"increment[-]", "method", "distance[-]", "relaxation_steps[-]", "corrections[-]",
       "steps_servo_over_this[-]"});
  for (const double increment : {0.005, 0.001, 0.0002}) {
    ShearRun servo;
    for (const Variant& variant : variants) {
      const ShearRun run = shear_frame(options, variant, shear, increment, spacing, tolerance);
      if (!run.failure.empty()) fmt::print("{}: {}\n", variant.name, run.failure);
      if (&variant == &variants.front()) servo = run;
      table.row({increment, variant.name, distance(run, servo), run.relaxation_steps,
                 run.servo_corrections, servo.relaxation_steps / run.relaxation_steps});
    }
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_servo.csv");
}

}  // namespace

void add_servo_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    double shear = 0.005;
    double tolerance = 1e-4;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("servo", "the published servo against direct relaxation");
  command->add_option("--shear", arguments->shear, "F12 at the end [-]")->capture_default_str();
  command->add_option("--tolerance", arguments->tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command->callback(
      [arguments, options] { run_study(*options, arguments->shear, arguments->tolerance); });
}

}  // namespace verification

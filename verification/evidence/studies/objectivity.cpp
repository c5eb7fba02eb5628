// `grainlaw_evidence objectivity`: rigid rotations, symmetry of the Cauchy stress, and energy.

#include "evidence/studies/study.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace verification {
namespace {

Tensor rotation(double angle) {
  Tensor q;
  q << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return q;
}

// |P(Q F) - Q P(F)| / |P(F)| of the same increment seen by a turned observer, and
// |sigma12 - sigma21| / |sigma|.
void study_rotations(const StudyOptions& options, const Material& material, double tolerance) {
  std::vector<Probe> probes =
      probe_path("drained", material, drained_segment(-0.02, drained_pressure, 20), 4);
  Table table(
      fmt::format("rigid rotation of single increments of 0.1 %, tolerance {:.0e} [-]", tolerance),
      {"axial_strain[-]", "angle[rad]", "objectivity_error[-]", "asymmetry[-]", "status"});
  for (Probe& probe : probes) {
    const Evaluation still = evaluate(probe.state, probe.deformation, 0);
    for (const double angle : {0.0, 1e-3, 0.5, 1.5, std::numbers::pi}) {
      const Tensor q = rotation(angle);
      const Tensor rotated_deformation = q * probe.deformation;
      const Evaluation rotated = evaluate(probe.state, rotated_deformation, 0);
      double error = std::numeric_limits<double>::quiet_NaN();
      double asymmetry = error;
      if (still.status == GRAINLAW_OK && rotated.status == GRAINLAW_OK) {
        error = (rotated.stress - q * still.stress).norm() / still.stress.norm();
        const Tensor sigma = cauchy_stress(rotated.stress, rotated_deformation);
        asymmetry = std::abs(sigma(0, 1) - sigma(1, 0)) / sigma.norm();
      }
      table.row({probe.strain, angle, error, asymmetry, grainlaw_status_text(rotated.status)});
    }
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_objectivity.csv");
}

// The work of the boundary goes into the contacts or is dissipated. The trapezoid rule on P:dF and
// the friction of whole increments agree with each other as increments shrink.
void study_energy(const StudyOptions& options, const Material& material) {
  constexpr double axial = 0.01;
  Table table("energy of the drained path to 1 % axial strain",
              {"increment[-]", "external_work[J]", "elastic_change[J]", "dissipated[J]",
               "mismatch_over_work[-]"});
  for (const int steps : {5, 10, 20, 50, 100}) {
    PointDriver driver(material, {});
    const double start = driver.record().elastic_energy;
    driver.run(drained_segment(-axial, drained_pressure, steps), {});
    const Record& end = driver.record();
    const double elastic = end.elastic_energy - start;
    table.row({axial / steps, end.external_work, elastic, end.dissipated_energy,
               (end.external_work - elastic - end.dissipated_energy) / end.external_work});
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_energy.csv");
}

}  // namespace

void add_objectivity_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto tolerance = std::make_shared<double>(1e-10);
  CLI::App* command =
      study.add_subcommand("objectivity", "rigid rotations, symmetry of stress, energy");
  command->add_option("--tolerance", *tolerance, "of the equilibria [-]")->capture_default_str();
  command->callback([tolerance, options] {
    const Material material = make_material(options->material(*tolerance));
    study_rotations(*options, material, *tolerance);
    study_energy(*options, material);
  });
}

}  // namespace verification

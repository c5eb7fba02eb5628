// `grainlaw_evidence tangent`: the returned tangents against central differences.

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <limits>
#include <optional>

namespace verification {
namespace {

// Differences of the result of one increment: everything starts from the same committed state.
struct Differences {
  Tangent tangent;  // central differences of P with respect to F [Pa]
  bool changed;     // a stencil point has other numbers of contacts than the centre
};

std::optional<Differences> central_differences(State& state, const Tensor& deformation, double step,
                                               const grainlaw_report& centre) {
  Differences result{Tangent::Zero(), false};
  for (int k = 0; k < 4; ++k) {
    Vector4 derivative = Vector4::Zero();
    for (const double sign : {1.0, -1.0}) {
      Tensor moved = deformation;
      moved(k / 2, k % 2) += sign * step;
      const Evaluation there = evaluate(state, moved, 0);
      if (there.status != GRAINLAW_OK || there.report.history_advanced != 0) return std::nullopt;
      derivative += sign / (2 * step) * to_vector(there.stress);
      result.changed = result.changed || !same_contacts(there.report, centre);
    }
    result.tangent.col(k) = derivative;
  }
  return result;
}

struct ProbeResult {
  double exact = std::numeric_limits<double>::quiet_NaN();
  double elastic = std::numeric_limits<double>::quiet_NaN();
  double perturbed = std::numeric_limits<double>::quiet_NaN();
  double differences = std::numeric_limits<double>::quiet_NaN();  // between two stencils
  double step = 0;                                                // of the finer stencil [-]
  bool changed = false;                                           // within that stencil
  bool claimed_exact = false;
  grainlaw_report report = grainlaw_report_default();
};

// A stencil must be so small that no contact changes its status, and so large that differences stand
// above the tolerance of the equilibria. The two neighbouring stencils that agree best are taken,
// without a change of status where there are such. How well these two agree is the accuracy of the
// differences themselves.
ProbeResult examine(Probe& probe) {
  constexpr std::array<double, 6> stencils{1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9};
  ProbeResult result;
  const Evaluation exact = evaluate(probe.state, probe.deformation, GRAINLAW_WANT_TANGENT_EXACT);
  result.report = exact.report;
  result.claimed_exact = exact.report.tangent_exact != 0;
  if (exact.status != GRAINLAW_OK) return result;
  const grainlaw_report centre = evaluate(probe.state, probe.deformation, 0).report;
  std::optional<Differences> best, last;
  for (const double step : stencils) {
    const auto next = central_differences(probe.state, probe.deformation, step, centre);
    if (last && next) {
      const double apart = (next->tangent - last->tangent).norm() / last->tangent.norm();
      const bool changed = last->changed || next->changed;
      const bool better = changed == result.changed ? apart < result.differences : !changed;
      if (!best || better) {
        best = last;
        result.differences = apart;
        result.step = step;
        result.changed = changed;
      }
    }
    last = next;
  }
  if (!best) return result;
  const auto error_of = [&](const Evaluation& other) {
    if (other.status != GRAINLAW_OK) return std::numeric_limits<double>::quiet_NaN();
    return (other.tangent - best->tangent).norm() / best->tangent.norm();
  };
  const auto error = [&](unsigned want) {
    return error_of(evaluate(probe.state, probe.deformation, want));
  };
  result.exact = error_of(exact);
  result.elastic = error(GRAINLAW_WANT_TANGENT_ELASTIC);
  result.perturbed = error(GRAINLAW_WANT_TANGENT_PERTURBED);
  return result;
}

void summarise(const std::vector<ProbeResult>& results) {
  Table table("relative error of the tangent (Frobenius) over the increments above",
              {"stencil", "states[-]", "exact_median[-]", "exact_max[-]", "elastic_median[-]",
               "elastic_max[-]", "perturbed_median[-]", "perturbed_max[-]"});
  double changed = 0;
  for (const bool with_change : {false, true}) {
    std::vector<double> exact, elastic, perturbed;
    for (const ProbeResult& result : results) {
      if (result.step == 0 || result.changed != with_change) continue;
      exact.push_back(result.exact);
      elastic.push_back(result.elastic);
      perturbed.push_back(result.perturbed);
    }
    if (with_change) changed = static_cast<double>(exact.size());
    table.row({with_change ? "a status changes in it" : "no status changes in it",
               static_cast<double>(exact.size()), median(exact), largest(exact), median(elastic),
               largest(elastic), median(perturbed), largest(perturbed)});
  }
  table.print();
  const auto all = static_cast<double>(results.size());
  double failed = 0;
  double claimed = 0;
  for (const ProbeResult& result : results) {
    failed += result.step == 0 ? 1 : 0;
    claimed += result.claimed_exact ? 1 : 0;
  }
  fmt::print(
      "share with a change inside every stencil {:.3f} [-], without differences {:.3f} [-], "
      "returned as exact {:.3f} [-]\n",
      changed / all, failed / all, claimed / all);
}

void run(const StudyOptions& options, double tolerance, int states, double axial, double shear) {
  constexpr int steps = 100;
  const Material material = make_material(options.material(tolerance));
  const int every = std::max(1, steps / states);
  std::vector<Probe> probes =
      probe_path("drained", material, drained_segment(-axial, drained_pressure, steps), every);
  for (Probe& probe : probe_path("shear", material, shear_segment(shear, steps), every))
    probes.push_back(std::move(probe));

  Table table(fmt::format("tangent of single increments at solver tolerance {:.0e} [-]", tolerance),
              {"path", "strain[-]", "contacts[-]", "sliding[-]", "status_changes[-]",
               "subincrements[-]", "exact_error[-]", "elastic_error[-]", "perturbed_error[-]",
               "differences_error[-]", "stencil[-]", "changes_inside"});
  std::vector<ProbeResult> results;
  Progress progress("tangents");
  for (Probe& probe : probes) {
    const ProbeResult r = examine(probe);
    results.push_back(r);
    table.row({probe.path, probe.strain, static_cast<double>(r.report.contacts),
               static_cast<double>(r.report.sliding), static_cast<double>(r.report.status_changes),
               static_cast<double>(r.report.subincrements), r.exact, r.elastic, r.perturbed,
               r.differences, r.step, r.changed ? "yes" : "no"});
    progress.update(static_cast<double>(results.size()) / static_cast<double>(probes.size()), "");
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_tangent.csv");
  summarise(results);
}

}  // namespace

void add_tangent_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    double tolerance = 1e-12;
    int states = 20;
    double axial = 0.1;
    double shear = 0.1;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("tangent", "tangents against central differences");
  command->add_option("--tolerance", arguments->tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command->add_option("--states", arguments->states, "increments looked at on either path [-]")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--axial", arguments->axial, "axial strain of the drained path [-]")
      ->capture_default_str();
  command->add_option("--shear", arguments->shear, "F12 of the shear path [-]")
      ->capture_default_str();
  command->callback([arguments, options] {
    run(*options, arguments->tolerance, arguments->states, arguments->axial, arguments->shear);
  });
}

}  // namespace verification

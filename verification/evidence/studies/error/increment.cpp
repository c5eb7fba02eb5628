// Single increments from exact starts: what stopping the relaxation early costs, and saves.

#include "evidence/studies/clock.hpp"
#include "evidence/studies/error/error.hpp"
#include "evidence/studies/statistics.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace verification::error_study {
namespace {

struct Sweep {
  Method method;
  double exact;        // tolerance of its own reference to try first [-]
  std::size_t starts;  // at most, from the path's end; slow methods do a few
  std::vector<double> tolerances;
};

const std::vector<Sweep>& sweeps() {
  static const std::vector<Sweep> all{
      {direct,
       reference_tolerance,
       100,
       {1e-2, 3e-3, 1e-3, 5e-4, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}},
      {advancing, reference_tolerance, 100, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}},
      {published, 1e-9, 100, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}},
      {frame_servo, 1e-5, 3, {1e-2, 1e-3, 1e-4}}};
  return all;
}

// P at the end of the increments at the method's tightest tolerance that converges.
struct Exact {
  double tolerance;
  std::vector<std::optional<Tensor>> stress;
};

Exact exact_stresses(const StudyOptions& options, const Sweep& sweep,
                     const std::vector<Start>& starts) {
  for (double tolerance = sweep.exact; tolerance < 1e-4; tolerance *= 10) {
    const Material material = make_material(with_method(options, sweep.method, tolerance));
    Exact exact{tolerance, {}};
    std::size_t found = 0;
    for (const Start& start : starts) {
      State state = state_at(material, start);
      const Evaluation evaluation = evaluate(state, start.deformation, 0);
      const bool good = evaluation.status == GRAINLAW_OK;
      if (!good && found == 0) break;  // it will not with the others
      exact.stress.push_back(good ? std::optional(evaluation.stress) : std::nullopt);
      ++found;
    }
    if (found > 0) return exact;
  }
  throw ComputationError(fmt::format("{}: no tolerance below 1e-4 converges", sweep.method.name));
}

IncrementRow measure_row(const StudyOptions& options, const std::string& path, const Method& method,
                         const std::vector<Start>& starts, const Exact& exact, double tolerance) {
  const Material material = make_material(with_method(options, method, tolerance));
  std::vector<double> errors, cpu, cpu_exact, steps, factorisations;
  double failures = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    State state = state_at(material, starts[k]);
    const auto [evaluation, spent] = time_evaluation(state, starts[k].deformation, 0);
    if (evaluation.status != GRAINLAW_OK || !exact.stress[k]) {
      ++failures;
      continue;
    }
    errors.push_back((evaluation.stress - *exact.stress[k]).norm() / exact.stress[k]->norm());
    cpu.push_back(spent);
    steps.push_back(static_cast<double>(evaluation.report.relaxation_steps));
    factorisations.push_back(evaluation.report.factorisations);
    if (std::string(method.name) == direct.name)
      cpu_exact.push_back(
          time_evaluation(state, starts[k].deformation, GRAINLAW_WANT_TANGENT_EXACT).cpu);
  }
  return {path,        method.name,       tolerance,     median(errors),         largest(errors),
          median(cpu), median(cpu_exact), median(steps), median(factorisations), failures};
}

}  // namespace

std::vector<IncrementRow> study_increments(const StudyOptions& options,
                                           const std::vector<Path>& paths) {
  std::vector<IncrementRow> rows;
  Table table(
      "error of single increments of 0.1 % from exact starts, |P - P_exact| / |P_exact|, exact: "
      "the same method at its tightest tolerance; drained to 1.5 %, shear to 1 %; medians",
      {"path", "method", "tolerance[-]", "error_median[-]", "error_worst[-]", "cpu[ms]",
       "cpu_with_exact_tangent[ms]", "relaxation_steps[-]", "factorisations[-]", "failures[-]",
       "exact_tolerance[-]"});
  Progress progress("single increments");
  double done = 0;
  for (const Path& path : paths)
    for (const Sweep& sweep : sweeps()) {
      const Method& method = sweep.method;
      const bool on_frame = std::string(method.boundary_type) == "frame-p";
      std::vector<Start> starts =
          exact_starts(make_material(with_method(options, on_frame ? frame_direct : direct,
                                                 reference_tolerance)),
                       path);
      if (starts.size() > sweep.starts)
        starts.erase(starts.begin(), starts.end() - static_cast<std::ptrdiff_t>(sweep.starts));
      const Exact exact = exact_stresses(options, sweep, starts);
      for (const double tolerance : sweep.tolerances) {
        progress.update(done / static_cast<double>(paths.size() * sweeps().size()),
                        fmt::format("{}, {}, {:.0e}", path.name, method.name, tolerance));
        const IncrementRow row = measure_row(options, path.name, method, starts, exact, tolerance);
        table.row({row.path, row.method, row.tolerance, row.error_median, row.error_worst, row.cpu,
                   row.cpu_exact, row.steps, row.factorisations, row.failures, exact.tolerance});
        rows.push_back(row);
      }
      ++done;
    }
  table.print();
  table.write(std::filesystem::path(options.output) / "error_increment.csv");
  return rows;
}

void study_tangents(const StudyOptions& options, const std::vector<Path>& paths) {
  Table table("extra time of the tangents, medians over the same increments",
              {"path", "tolerance[-]", "tangent", "cpu[ms]", "extra_cpu[ms]", "ratio[-]"});
  for (const Path& path : paths)
    for (const double tolerance : {1e-3, 1e-6}) {
      const std::vector<Start> starts =
          exact_starts(make_material(with_method(options, direct, reference_tolerance)), path);
      const Material material = make_material(with_method(options, direct, tolerance));
      double plain = 0;
      for (const auto& [name, want] :
           {std::pair{"none", 0U}, std::pair{"exact", tangent_bit("exact")},
            std::pair{"elastic", tangent_bit("elastic")},
            std::pair{"perturbed", tangent_bit("perturbed")}}) {
        std::vector<double> cpu;
        for (const Start& start : starts)
          cpu.push_back(time_evaluation(state_at(material, start), start.deformation, want).cpu);
        if (want == 0) plain = median(cpu);
        table.row(
            {path.name, tolerance, name, median(cpu), median(cpu) - plain, median(cpu) / plain});
      }
    }
  table.print();
  table.write(std::filesystem::path(options.output) / "error_tangent.csv");
}

}  // namespace verification::error_study

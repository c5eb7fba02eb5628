// Whole paths: error by increment size, tolerance and method, against CPU time.

#include "evidence/studies/error/error.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace verification::error_study {
namespace {

// The frame serves only the servo, in large increments.
constexpr int frame_coarser = 10;

struct Sweep {
  Method method;
  std::vector<double> tolerances;
  int least_increments, most_increments;
};

// 1 % in so many increments; each divides the number of the reference.
constexpr int counts[] = {1, 4, 10, 40, 100, 400, 1000};

const std::vector<Sweep>& sweeps() {
  static const std::vector<Sweep> all{
      {direct, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}, 1, 1000},
      {advancing, {1e-2, 1e-3, 1e-4, 1e-6}, 1, 400},
      {published, {1e-2, 1e-3, 1e-4}, 1, 100},
      {frame_servo, {1e-3, 1e-4}, 4, 10}};
  return all;
}

// At the tightest tolerance at which every increment converges. Halving the increments says how far
// from the limit it is: the error is of first order.
Replay make_reference(const StudyOptions& options, const Method& method, const Path& path,
                      int increments, Table& table) {
  Replay fine;
  for (double tolerance = reference_tolerance; tolerance < 1e-7; tolerance *= 10) {
    const Material material = make_material(with_method(options, method, tolerance));
    fine = replay(material, path, increments);
    if (!fine.failure.empty()) continue;
    const Replay coarse = replay(material, path, increments / 2);
    table.row({path.name, method.name, tolerance, path_end / increments, path_error(coarse, fine),
               1e-3 * fine.cpu});
    return fine;
  }
  throw ComputationError(
      fmt::format("the reference {} {} failed: {}", path.name, method.name, fine.failure));
}

}  // namespace

std::vector<PathRow> study_paths(const StudyOptions& options, const std::vector<Path>& paths,
                                 int reference_increments) {
  for (const int count : counts)
    if (reference_increments % (2 * count) != 0)
      throw InputError(fmt::format("--reference {}: expected a multiple of {}",
                                   reference_increments, 2 * count));
  std::vector<PathRow> rows;
  Table references("references; change of P when their increments double",
                   {"path", "method", "tolerance[-]", "increment[-]", "change[-]", "cpu[s]"});
  Table table(
      fmt::format("error along the path to {:g} %, largest |P - P_ref| / |P_ref|", 100 * path_end),
      {"path", "method", "tolerance[-]", "increment[-]", "error[-]", "cpu_path[ms]",
       "cpu_evaluation[ms]", "relaxation_steps[-]", "note"});
  Progress progress("paths");
  double done = 0;
  for (const Path& path : paths) {
    const Replay cell = make_reference(options, direct, path, reference_increments, references);
    const Replay frame = make_reference(options, frame_direct, path,
                                        reference_increments / frame_coarser, references);
    for (const Sweep& sweep : sweeps()) {
      const bool on_frame = std::string(sweep.method.boundary_type) == "frame-p";
      for (const double tolerance : sweep.tolerances) {
        const Material material = make_material(with_method(options, sweep.method, tolerance));
        for (const int count : counts) {
          if (count < sweep.least_increments || count > sweep.most_increments) continue;
          progress.update(
              done / static_cast<double>(paths.size() * sweeps().size()),
              fmt::format("{}, {}, {:.0e}, {}", path.name, sweep.method.name, tolerance, count));
          const Replay run = replay(material, path, count);
          rows.push_back({path.name, sweep.method.name, tolerance, path_end / count,
                          path_error(run, on_frame ? frame : cell), run.cpu, run.cpu / count,
                          run.relaxation_steps, run.failure});
          const PathRow& row = rows.back();
          table.row({row.path, row.method, row.tolerance, row.increment, row.error, row.cpu,
                     row.evaluation, row.steps, row.note});
        }
      }
      ++done;
    }
  }
  references.print();
  references.write(std::filesystem::path(options.output) / "error_reference.csv");
  table.print();
  table.write(std::filesystem::path(options.output) / "error_path.csv");
  return rows;
}

}  // namespace verification::error_study

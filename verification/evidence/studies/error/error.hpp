// What the parts of `grainlaw_evidence error` share: methods, prescribed paths, runs along them.
#pragma once

#include "evidence/studies/study.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace verification::error_study {

// A way to find the equilibrium of an increment.
struct Method {
  const char* name;
  const char* boundary_type;
  const char* boundary_method;
  const char* solver_method;
};
inline constexpr Method direct{"direct", "periodic-cell", "direct", "direct"};
inline constexpr Method advancing{"advancing history", "periodic-cell", "direct", "advancing"};
inline constexpr Method published{"published relaxation", "periodic-cell", "direct", "published"};
inline constexpr Method frame_direct{"direct on a frame", "frame-p", "direct", "direct"};
inline constexpr Method frame_servo{"published servo", "frame-p", "servo", "published"};

// Tolerance of everything that is called exact here [-]. The library does not go below rounding.
inline constexpr double reference_tolerance = 1e-12;
// Axial strain or F12 at the ends of the paths [-]: before the peak, where no packing is chaotic.
inline constexpr double path_end = 0.01;
inline constexpr double increment_size = 0.001;

// yade400.toml with this method and tolerance [-], its contacts nudged() that many times.
MaterialSource with_method(const StudyOptions& options, const Method& method, double tolerance,
                           int repeat = 0);

// F(t), linear between its points.
struct Path {
  std::string name;
  std::vector<Tensor> points;  // the first one is I
  double step = increment_size;

  [[nodiscard]] Tensor at(double t) const;  // t = 0..1
  [[nodiscard]] Path until(double end) const;
};

// Drained compression to 1.5 %, led once by stress control at the reference tolerance, and simple
// shear to path_end.
Path drained_path(const StudyOptions& options);
Path shear_path();

// A path in equal increments. Not done: an increment failed, and `failure` says where and why.
struct Replay {
  std::vector<Tensor> stress;  // P after every increment [Pa]
  double cpu = 0;              // of all evaluations [ms]
  double relaxation_steps = 0;
  std::string failure;
};
Replay replay(const Material& material, const Path& path, int increments);

// Largest |P - P_ref| / |P_ref| at tenths of the path, or after the increments that are larger;
// NaN when the run failed. The reference must have a multiple of the increments.
double path_error(const Replay& run, const Replay& reference);

// An increment of a path with its exact start.
struct Start {
  std::vector<std::byte> bytes;  // the committed state
  Tensor deformation;            // at the end of the increment
};
std::vector<Start> exact_starts(const Material& material, const Path& path);
State state_at(const Material& material, const Start& start);

// Single increments of 0.1 % from exact starts.
struct IncrementRow {
  std::string path, method;
  double tolerance;
  double error_median, error_worst;  // |P - P_exact| / |P_exact| against the method's tightest [-]
  double cpu, cpu_exact;             // median, without and with the exact tangent [ms]
  double steps, factorisations;      // medians, without a tangent
  double failures;
};
std::vector<IncrementRow> study_increments(const StudyOptions& options,
                                           const std::vector<Path>& paths);
// Extra time of the tangents.
void study_tangents(const StudyOptions& options, const std::vector<Path>& paths);

// The paths in increments from 1 % down, each method and tolerance.
struct PathRow {
  std::string path, method;
  double tolerance, increment;
  double error;       // [-]
  double cpu;         // of the path [ms]
  double evaluation;  // mean of an evaluation [ms]
  double steps;       // relaxation steps of the path
  std::string note;   // "" or why it failed
};
std::vector<PathRow> study_paths(const StudyOptions& options, const std::vector<Path>& paths,
                                 int reference_increments);

// CPU per evaluation against the number of particles, and the standard error of cpu_exact over
// packings.
struct NumberRow {
  double particles, packings, cpu, cpu_exact, error;
  double median, median_error;  // of a packing's increments, with the exact tangent
  double steps, factorisations;
};
std::vector<NumberRow> study_numbers(const StudyOptions& options, int largest_count);

// The drained path's bars, which are of a machine that `slower` is this one's CPU time over.
void study_budget(const StudyOptions& options, const std::vector<IncrementRow>& increments,
                  double slower);

struct YadeRow {
  std::string setting, kind;        // kind: coupling, usual, best
  double error, cpu_low, cpu_high;  // [-], [ms]
  double recorded;                  // the middle, on the machine it was recorded on [ms]
};
// Times as recorded, times `slower`.
std::vector<YadeRow> read_yade(const StudyOptions& options, double slower);
// CPU time of a step of YADE here over what it was where its times were recorded, from its time per
// particle here [ns]; 0: not known, 1 is assumed.
double slower_than_recorded(double yade_step);
void compare_with_yade(const StudyOptions& options, const std::vector<IncrementRow>& increments,
                       const std::vector<YadeRow>& yade);

void draw_increments(const StudyOptions& options, const std::vector<IncrementRow>& rows,
                     const std::vector<YadeRow>& yade);
void draw_paths(const StudyOptions& options, const std::vector<PathRow>& rows);
void draw_numbers(const StudyOptions& options, const std::vector<NumberRow>& rows, double exponent);

}  // namespace verification::error_study

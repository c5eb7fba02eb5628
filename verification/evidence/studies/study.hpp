// What the studies share: where scenes lie, the reference material, runs along a path.
#pragma once

#include "app/material.hpp"
#include "app/table.hpp"
#include "point/driver.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace verification {

struct StudyOptions {
  std::string scenes = "verification/scenes";  // directory with yade400.toml and the other scenes
  std::string output = ".";

  // A file in the scenes' directory. Throws InputError when it is not there.
  [[nodiscard]] std::filesystem::path scene(const std::string& name) const;
  // yade400.toml, to be changed by the caller, at this solver tolerance [-]; its contacts nudged()
  // that many times.
  [[nodiscard]] MaterialSource material(double tolerance, int repeat = 0) const;
};

// What multiplies a stiffness in the repeats of a run [-]: too little for anybody to tell, but it
// rounds otherwise, and what lies beyond the peak depends on that.
inline double nudged(int repeat) {
  constexpr double smallest = 1e-6;
  return 1 + smallest * repeat;
}

// An increment to look at more closely.
struct Probe {
  std::string path;  // "drained" or "shear"
  State state;       // committed one step before, trial dropped or not
  Tensor deformation;
  double strain;  // axial strain or F12 at the end of the increment [-]
};

// Increments number every, 2 every, ... of a path of `steps` steps.
std::vector<Probe> probe_path(const std::string& name, const Material& material,
                              const Segment& segment, int every);

// Whether no contact changed its status between two evaluations, by their numbers.
bool same_contacts(const grainlaw_report& a, const grainlaw_report& b);

// Stress control that gets over collapses after the peak at any price: studies look at increments,
// not at the path.
PointOptions study_options();

// The lateral stress of the drained tests [Pa].
inline constexpr double drained_pressure = -100e3;

// Each reads its own options under `study` and runs in its callback.
void add_tangent_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_newton_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_objectivity_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_asymmetry_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_servo_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_ensemble_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_drag_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_energy_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_timing_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_spheres_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_reach_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_start_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_error_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_features_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_batch_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);
void add_stability_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);

}  // namespace verification

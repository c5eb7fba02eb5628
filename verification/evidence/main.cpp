// grainlaw_evidence: the measurements behind the claims, and the figures of the papers.

#include "app/program.hpp"
#include "evidence/papers/guo2014_multiscale/multiscale.hpp"
#include "evidence/papers/liu2017_boundary/boundary.hpp"
#include "evidence/papers/liu2018_waves/waves.hpp"
#include "evidence/papers/liu2019_biaxial/biaxial.hpp"
#include "evidence/studies/study.hpp"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  using namespace verification;
  CLI::App app("Measures what the project claims", "grainlaw_evidence");
  const auto options = std::make_shared<StudyOptions>();
  app.add_option("--scenes", options->scenes, "directory with the scenes")->capture_default_str();
  app.add_option("--output", options->output, "directory for the results")->capture_default_str();
  add_tangent_study(app, options);
  add_newton_study(app, options);
  add_objectivity_study(app, options);
  add_asymmetry_study(app, options);
  add_servo_study(app, options);
  add_ensemble_study(app, options);
  add_drag_study(app, options);
  add_energy_study(app, options);
  add_timing_study(app, options);
  add_spheres_study(app, options);
  add_reach_study(app, options);
  add_start_study(app, options);
  add_error_study(app, options);
  add_features_study(app, options);
  add_batch_study(app, options);
  add_stability_study(app, options);
  add_liu2017_boundary_study(app, options);
  add_liu2017_published_study(app, options);
  add_liu2018_waves_study(app, options);
  add_liu2019_biaxial_study(app, options);
  add_guo2014_multiscale_study(app, options);
  return run_program(app, argc, argv);
}

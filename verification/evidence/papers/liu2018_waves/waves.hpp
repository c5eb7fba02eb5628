// `grainlaw_evidence liu2018_waves`: what the waves of Liu's thesis (2018), chapter 4, show, from the tables
// that the scenes in liu2018_waves/ left in the output directory. What was not run is left out.
#pragma once

#include "evidence/papers/results.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace verification {

inline constexpr double pulse_amplitude = 1.8e-3;  // of all scenes but figure_4_6.toml [m]

class WaveStudy {
 public:
  explicit WaveStudy(std::filesystem::path directory) : results(std::move(directory)) {}

  using Run = std::optional<PaperRun>;
  [[nodiscard]] Run load(const std::string& name) const { return load_run(results, name); }

  // Errors of meshes against particles, relative to the amplitude, coarse to fine; none that was not
  // run. `section` is 1, the near one, or 2.
  [[nodiscard]] std::vector<double> errors(const std::string& mesh_scene,
                                           const std::string& particles,
                                           const std::vector<int>& meshes, int section,
                                           double amplitude = pulse_amplitude) const;
  // Facts of these: every mesh, the finest, and by how much refinement raises the error at most.
  void add_errors(const std::string& name, const std::string& mesh_scene,
                  const std::string& particles, const std::vector<int>& meshes,
                  double amplitude = pulse_amplitude);

  std::filesystem::path results;  // read and written
  Facts facts{"liu2018"};
};

// Largest difference of the displacements at a section, relative to the amplitude.
double apart(const PaperRun& a, const PaperRun& b, const char* section,
             double amplitude = pulse_amplitude);
// When a section has moved by half of the amplitude [ms].
double arrival(const PaperRun& run, const char* section, double amplitude);
// A column against the time in ms.
Curve wave_curve(const PaperRun& run, const char* column, double factor, const char* colour,
                 Stroke stroke, const std::string& title);

void study_string_waves(WaveStudy& study);   // figures 4.4 and 4.5, dispersion
void study_packing_waves(WaveStudy& study);  // figures 4.6 to 4.11
void study_why_waves_differ(WaveStudy& study);
void study_waves_with_inertia(WaveStudy& study);
// Section 4.4.4, late oscillations, a shear wave; scenes of liu2018_waves.
void study_further_waves(WaveStudy& study, const std::filesystem::path& scenes);
void study_wave_cost(WaveStudy& study);

void add_liu2018_waves_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);

}  // namespace verification

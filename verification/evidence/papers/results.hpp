// What the scenes of a paper left behind, in the paper's dimensionless numbers.
#pragma once

#include "app/csv.hpp"
#include "app/figure.hpp"
#include "evidence/facts.hpp"
#include "evidence/studies/study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace verification {

// Units of Liu, Bosco & Suiker (2017): the stress is sigma R / kn with the mean radius R, sigma in
// Pa and kn in N/m, for discs 1 mm thick.
struct PaperUnits {
  double stiffness = 1;    // kn [N/m]
  double mean_radius = 1;  // [m]
  double thickness = 1;    // [m]

  [[nodiscard]] double stress() const { return mean_radius / stiffness; }  // per Pa
};

// Reads [contact] kn, thickness, and [packing] radii or radius of a material file. Throws
// InputError.
PaperUnits read_units(const std::filesystem::path& material);

// One case of a scene.
struct PaperRun {
  std::string name;
  CsvTable history;
  std::optional<CsvTable> particles;  // with particle_measures

  [[nodiscard]] std::size_t steps() const { return history.rows(); }
  // A column times a factor.
  [[nodiscard]] std::vector<double> column(const char* name, double factor = 1) const;
};

// From NAME.csv in the directory; nothing when it was not run.
std::optional<PaperRun> load_run(const std::filesystem::path& directory, const std::string& name);

// SCENE_cases.csv: how every case ended. Empty when it was not run.
struct CaseEnds {
  explicit CaseEnds(const std::filesystem::path& path);
  [[nodiscard]] std::optional<std::size_t> find(const std::string& wanted) const;

  CsvTable table;
  std::vector<std::string> name;
};

// |sigma| R / kn, the Frobenius norm, at every step.
std::vector<double> stress_norm(const PaperRun& run, const PaperUnits& units);

// Eq. 42: (integral over F12 of |sigma R / kn|^2)^(1/2), trapezoid rule over the steps of the run to
// F12 = until.
double integrated_norm(const PaperRun& run, const PaperUnits& units, double until = 1);

// How often and by how much `stiff` carries and stores more than `soft`, over their common steps.
struct Order {
  double share = 0;         // of steps with |sigma_stiff| >= |sigma_soft| [-]
  double mean_ratio = 0;    // of the integrals over F12 of |sigma| [-]
  double energy_share = 0;  // of steps with no less energy stored in the contacts [-]
  double spent_share = 0;   // the same, stored and dissipated [-]
  double until = 0;         // F12 of the last common step [-]
  int steps = 0;            // common ones, F = I included
};
Order compare(const PaperRun& stiff, const PaperRun& soft, const PaperUnits& units);

// Largest and least ratio of a number to the one before it.
double largest_rise(const std::vector<double>& values);
double least_rise(const std::vector<double>& values);
// Largest over least.
double spread(const std::vector<double>& values);

// Where the scenes lie, where their results are, and what is found on the way.
struct PaperStudy {
  std::filesystem::path scenes;   // of the paper
  std::filesystem::path results;  // read and written
  Facts facts;

  [[nodiscard]] std::optional<PaperRun> run(const std::string& name) const {
    return load_run(results, name);
  }
};

}  // namespace verification

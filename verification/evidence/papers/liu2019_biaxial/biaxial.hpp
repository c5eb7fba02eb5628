// `grainlaw_evidence liu2019_biaxial`: figures and tables of Liu, Bosco & Suiker (2019), from the tables
// that the scenes in liu2019_biaxial/ left in the output directory.
#pragma once

#include "evidence/papers/results.hpp"

#include <optional>
#include <string>
#include <vector>

namespace verification {

// A biaxial test, counted from the state under isotropic stress, its first row.
struct Biaxial {
  std::string name;
  std::vector<double> strain;        // axial, compression positive (eq. 41) [-]
  std::vector<double> ratio;         // |s11 - s22| / |s11 + s22| of the mean stress (eq. 40) [-]
  std::vector<double> volume;        // J / J of the start - 1, dilation positive [-]
  std::vector<double> coordination;  // [-]
  std::vector<double> anisotropy;    // eq. 38 [-]

  [[nodiscard]] std::size_t peak() const;  // row of the largest ratio
  // Linear between the rows; NaN outside.
  [[nodiscard]] double ratio_at(double strain) const;
};

// From the row `start` of its history on.
std::optional<Biaxial> load_biaxial(const PaperStudy& study, const std::string& name,
                                    std::size_t start = 0);

// Figures 4 to 14, the comparison of multi-scale and direct simulation, the table of costs.
void study_biaxial(PaperStudy& study);
void tabulate_costs(const PaperStudy& study);
void compare_with_direct(PaperStudy& study);  // also every packing of dns_packings.toml
void compare_sizes(PaperStudy& study);        // specimens A, B, C of each packing with its mesh
void draw_points(PaperStudy& study);          // figure 6
void study_initial_anisotropy(PaperStudy& study);  // figures 12 to 14
void count_made_packings(PaperStudy& study);       // table 3, figure 12

void add_liu2019_biaxial_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options);

}  // namespace verification

// `grainlaw study papers-002`: figures and tables of Liu, Bosco & Suiker (2017), from the tables
// that the scenes in papers-002/ left in the output directory.
#pragma once

#include "papers/results.hpp"

namespace verification {

// Where the scenes lie, where their results are, and what is found on the way.
struct PaperStudy {
  std::filesystem::path scenes;   // .../papers-002
  std::filesystem::path results;  // read and written
  Facts facts;

  [[nodiscard]] std::optional<PaperRun> run(const std::string& name) const {
    return load_run(results, name);
  }
};

// Each draws figure_NN.svg and .png, writes its tables and adds its facts. What was not run is left
// out.
void study_regular_packings(PaperStudy& study);  // figures 2, 4, 5
void study_irregular_packings(PaperStudy& study);  // figures 7, 9, 10, reach of T
void study_packings(PaperStudy& study);    // figure 6: coordination; T at rest
void study_sizes(PaperStudy& study);       // figure 10 as an ensemble
void study_order(PaperStudy& study);       // D >= P >= T in stress and in energy
void study_layer(PaperStudy& study);       // figure 11
void study_servo_cost(PaperStudy& study);  // servo against direct, all figures

}  // namespace verification

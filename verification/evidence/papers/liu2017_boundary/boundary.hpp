// `grainlaw_evidence liu2017_boundary`: figures and tables of Liu, Bosco & Suiker (2017), from the tables
// that the scenes in liu2017_boundary/ left in the output directory.
#pragma once

#include "evidence/papers/results.hpp"

namespace verification {

// Each draws figure_NN.svg and .png, writes its tables and adds its facts. What was not run is left
// out.
void study_regular_packings(PaperStudy& study);    // figures 2, 4, 5
void study_irregular_packings(PaperStudy& study);  // figures 7, 9, 10, reach of T
void study_packings(PaperStudy& study);            // figure 6: coordination; T at rest
void study_sizes(PaperStudy& study);               // figure 10 as an ensemble
void study_order(PaperStudy& study);               // D >= P >= T in stress and in energy
void study_layer(PaperStudy& study);               // figure 11
void study_servo_cost(PaperStudy& study);          // servo against direct, all figures

// T as published: what grainlaw_evidence liu2017_published left.
void study_published(PaperStudy& study);

void add_liu2017_published_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options);
void add_liu2017_boundary_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options);

}  // namespace verification

// `grainlaw_evidence guo2014_multiscale`: figures and tables of Guo & Zhao (2014), from the tables that the scenes
// in guo2014_multiscale/ left in the output directory. What was not run is left out.
#pragma once

#include "evidence/papers/results.hpp"

namespace verification {

struct HierarchicalStudy {
  std::filesystem::path results;  // read and written
  Facts facts{"guo2014"};
};

// Run of a scene of finite elements: NAME.csv, NAME_force.csv, NAME_cost.csv.
struct MeshRun {
  std::string name;
  CsvTable history;
  CsvTable forces;
  std::optional<CsvTable> cost;

  [[nodiscard]] std::size_t steps() const { return history.rows(); }
};
std::optional<MeshRun> load_mesh_run(const std::filesystem::path& directory,
                                     const std::string& name);

// Column `name` of NAME_every_FIELD.csv: rows are steps, one column per integration point.
std::optional<CsvTable> load_every(const std::filesystem::path& directory, const std::string& name,
                                   const std::string& field);

// A lattice alone from the isotropic stress on that its first segment leads to; strains count from
// there.
std::optional<PaperRun> load_lattice(const std::filesystem::path& directory,
                                     const std::string& name = "rve_hexagonal");

void add_guo2014_multiscale_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options);

void study_single_element(HierarchicalStudy& study);  // figures 6, 7
void study_localisation(HierarchicalStudy& study);    // Newton on meshes, figures 10, 12, 13
void study_local_response(HierarchicalStudy& study);  // figures 15, 17
void study_liquefaction(HierarchicalStudy& study);    // figures 20, 22
void study_cost_of_scenes(HierarchicalStudy& study);  // table of all runs, error against time

}  // namespace verification

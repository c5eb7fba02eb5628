#include "papers/papers_004.hpp"

#include <algorithm>
#include <numeric>

namespace verification {

std::optional<MeshRun> load_mesh_run(const std::filesystem::path& directory,
                                     const std::string& name) {
  const auto path = [&](const char* end) { return directory / (name + end); };
  const auto there = [&](const char* end) { return std::filesystem::is_regular_file(path(end)); };
  if (!there(".csv") || !there("_force.csv")) return std::nullopt;
  MeshRun run{name, read_csv(path(".csv")), read_csv(path("_force.csv")), std::nullopt};
  if (there("_cost.csv")) run.cost = read_csv(path("_cost.csv"));
  return run;
}

std::optional<CsvTable> load_every(const std::filesystem::path& directory, const std::string& name,
                                   const std::string& field) {
  const auto path = directory / (name + "_every_" + field + ".csv");
  if (!std::filesystem::is_regular_file(path)) return std::nullopt;
  return read_csv(path);
}

void add_papers_004_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = study.add_subcommand(
      "papers-004", "figures and tables of the scenes in papers-004, which were run before");
  command->callback([options] {
    HierarchicalStudy papers{options->output, {}};
    study_single_element(papers);
    study_localisation(papers);
    study_local_response(papers);
    study_liquefaction(papers);
    study_cost_of_scenes(papers);
    papers.facts.print();
    papers.facts.write(papers.results / "papers_004_facts.csv");
  });
}

}  // namespace verification

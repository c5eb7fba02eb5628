#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

constexpr double isotropic = -100e3;  // stress that the lattice alone is led to first [Pa]

}  // namespace

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

std::optional<PaperRun> load_lattice(const std::filesystem::path& directory,
                                     const std::string& name) {
  auto run = load_run(directory, name);
  if (!run) return run;
  // Compression begins after the last step at which the axial stress is still prescribed.
  CsvTable& table = run->history;
  const std::vector<double> stress = table["sigma22"];
  std::size_t start = 0;
  for (std::size_t k = 0; k < stress.size(); ++k)
    if (std::abs(stress[k] / isotropic - 1) < 1e-3) start = k;
  for (std::vector<double>& column : table.columns)
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(start));
  for (std::size_t c = 0; c < table.names.size(); ++c)
    if (table.names[c] == "axial_strain") {
      const double first = table.columns[c].empty() ? 0 : table.columns[c].front();
      for (double& strain : table.columns[c]) strain -= first;
    }
  return run;
}

void add_guo2014_multiscale_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = study.add_subcommand(
      "guo2014_multiscale",
      "figures and tables of the scenes in guo2014_multiscale, which were run before");
  command->callback([options] {
    HierarchicalStudy papers{options->output};
    study_single_element(papers);
    study_localisation(papers);
    study_local_response(papers);
    study_liquefaction(papers);
    study_cost_of_scenes(papers);
    papers.facts.write(papers.results);
  });
}

}  // namespace verification

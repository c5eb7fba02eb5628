#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <CLI/CLI.hpp>

namespace verification {

void add_liu2017_boundary_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = app.add_subcommand(
      "liu2017_boundary", "figures and tables of the scenes of this name, which were run before");
  command->callback([options] {
    PaperStudy papers{std::filesystem::path(options->scenes) / "liu2017_boundary", options->output,
                      Facts("liu2017")};
    study_regular_packings(papers);
    study_packings(papers);
    study_irregular_packings(papers);
    study_sizes(papers);
    study_order(papers);
    study_layer(papers);
    study_servo_cost(papers);
    study_published(papers);
    papers.facts.write(papers.results);
  });
}

}  // namespace verification

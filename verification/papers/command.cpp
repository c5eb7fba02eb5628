#include "papers/biaxial.hpp"
#include "papers/papers.hpp"

namespace verification {

void add_papers_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = study.add_subcommand(
      "papers-002", "figures and tables of the scenes in papers-002, which were run before");
  command->callback([options] {
    PaperStudy papers{std::filesystem::path(options->scenes) / "papers-002", options->output, {}};
    study_regular_packings(papers);
    study_packings(papers);
    study_irregular_packings(papers);
    study_sizes(papers);
    study_order(papers);
    study_layer(papers);
    study_servo_cost(papers);
    papers.facts.print();
    papers.facts.write(papers.results / "papers_002_facts.csv");
  });
  CLI::App* biaxial = study.add_subcommand(
      "papers-000", "figures and tables of the scenes in papers-000, which were run before");
  biaxial->callback([options] {
    PaperStudy papers{std::filesystem::path(options->scenes) / "papers-000", options->output, {}};
    study_biaxial(papers);
    papers.facts.print();
    papers.facts.write(papers.results / "papers_000_facts.csv");
  });
}

}  // namespace verification

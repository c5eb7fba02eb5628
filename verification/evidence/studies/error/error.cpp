// `grainlaw_evidence error`: error of P against CPU time, by tolerance, increment, method, tangent and
// number of particles, beside YADE.

#include "evidence/studies/error/error.hpp"

#include "app/bounds.hpp"

#include <algorithm>

namespace verification {
namespace {

const std::vector<std::string> all_parts{"increments", "paths", "numbers"};

struct Arguments {
  std::vector<std::string> parts = all_parts;
  int reference_increments = 4000;
  int largest_count = 6400;
  double yade_step = 0;
};

void run_study(const StudyOptions& options, const Arguments& arguments) {
  using namespace error_study;
  std::filesystem::create_directories(options.output);
  const auto wanted = [&](const char* part) {
    return std::find(arguments.parts.begin(), arguments.parts.end(), part) != arguments.parts.end();
  };
  const Path drained = drained_path(options);
  const Path shear = shear_path();
  if (wanted("increments")) {
    const double slower = slower_than_recorded(arguments.yade_step);
    const std::vector<YadeRow> yade = read_yade(options, slower);
    const std::vector<IncrementRow> increments = study_increments(options, {drained, shear});
    draw_increments(options, increments, yade);
    compare_with_yade(options, increments, yade);
    study_budget(options, increments, slower);
    study_tangents(options, {drained, shear});
  }
  if (wanted("paths"))
    draw_paths(options, study_paths(options, {drained.until(path_end), shear},
                                    arguments.reference_increments));
  if (wanted("numbers")) study_numbers(options, arguments.largest_count);
}

}  // namespace

void add_error_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("error", "error of P against CPU time");
  command->add_option("PART", arguments->parts, "what to measure; default: all")
      ->check(CLI::IsMember(all_parts));
  command
      ->add_option("--reference", arguments->reference_increments,
                   "increments of the reference paths [-]")
      ->capture_default_str();
  command
      ->add_option("--largest", arguments->largest_count,
                   "most particles; packings are made once and kept [-]")
      ->check(CLI::Range(100, 6400))
      ->capture_default_str();
  command
      ->add_option("--yade-step", arguments->yade_step,
                   "CPU time of a step of YADE on this machine, per particle [ns]; 0: its times "
                   "as they were recorded on another")
      ->check(at_least(0));
  command->callback([arguments, options] { run_study(*options, *arguments); });
}

}  // namespace verification

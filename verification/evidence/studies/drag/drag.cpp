// `grainlaw_evidence drag [SECTION ...]`: the law in time (solver.viscous_number) against what is asked
// of it, and beside equilibrium.

#include "evidence/studies/drag/sections.hpp"

#include "app/bounds.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace verification {
namespace {

struct Section {
  const char* name;
  void (*run)(drag::Study&);
};
constexpr std::array<Section, 10> sections{{{"tangents", drag::check_tangents},
                                            {"short", drag::measure_short},
                                            {"limit", drag::measure_limit},
                                            {"stiffness", drag::measure_stiffness},
                                            {"bias", drag::measure_bias},
                                            {"yade", drag::compare_with_yade},
                                            {"fading", drag::fade},
                                            {"stiff", drag::lead_stiff},
                                            {"jumps", drag::count_jumps},
                                            {"cost", drag::measure_cost}}};

}  // namespace

void add_drag_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    std::vector<std::string> sections;
    double number = 1e-3;
    std::vector<std::string> keys;
    int packings = 0;
    int dimension = 0;
    double stiffness = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("drag", "the law in time against what is asked of it");
  std::vector<std::string> names;
  for (const Section& section : sections) names.emplace_back(section.name);
  command->add_option("sections", arguments->sections, "sections of it; none: all")
      ->check(CLI::IsMember(names));
  command->add_option("--number", arguments->number, "solver.viscous_number [-]; 0: not given")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--solver", arguments->keys,
                      "further lines of [solver] of the law, \"KEY = VALUE\"");
  command
      ->add_option("--packings", arguments->packings,
                   "at most so many of each kind [-]; 0: as many as a section has")
      ->check(at_least(0))
      ->capture_default_str();
  command
      ->add_option("--dimension", arguments->dimension,
                   "section jumps with discs, 2, or spheres, 3, alone; 0: both")
      ->check(CLI::IsMember({0, 2, 3}));
  command
      ->add_option("--stiffness", arguments->stiffness,
                   "section jumps at this kn / p alone: 300, 3000 or 30000 [-]; 0: all three")
      ->check(CLI::IsMember({0.0, 300.0, 3e3, 3e4}));
  command->callback([arguments, options] {
    drag::Study all{{*options, arguments->number, arguments->keys},
                    arguments->packings,
                    arguments->dimension,
                    arguments->stiffness};
    for (const Section& section : sections) {
      const auto& wanted = arguments->sections;
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), section.name) != wanted.end())
        section.run(all);
    }
  });
}

}  // namespace verification

// `grainlaw choose MATERIAL.toml --error E`: measure error against run time, and print the keys to set.

#include "app/bounds.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/output.hpp"
#include "app/progress.hpp"
#include "app/table.hpp"
#include "app/text.hpp"
#include "choose/choices.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace verification {
namespace {

struct ChooseArguments {
  std::string material;
  std::optional<double> error, budget;  // [-], [ms]
  double strain = 1e-2;
  Destination destination;
};

constexpr double percent = 100;
constexpr double thousand = 1e3;

void print_choice(const Trial& trial, const Tried& best) {
  const Choice& choice = best.choice;
  fmt::print(
      "\nerror of the stress {:.1e} in the median and {:.1e} at most, {:.3g} ms of one core for a "
      "point and {:g} % of strain\n\n",
      *best.error, *best.largest, thousand * best.seconds, percent * trial.strain);
  fmt::print("# load steps of {:g} % of strain\n[solver]\ntolerance = {:g}\n",
             percent * choice.increment, choice.tolerance);
  if (choice.viscous_number > 0) fmt::print("viscous_number = {:g}\n", choice.viscous_number);
}

// The choice that was asked for, of the best. Throws ComputationError where there is none, with the
// nearest.
const Tried& chosen(const ChooseArguments& asked, const Trial& trial,
                    const std::vector<Tried>& best) {
  if (best.empty())
    throw ComputationError("no choice reaches the end of the paths: choose a smaller --strain");
  const auto exact = std::find_if(best.begin(), best.end(), [&](const Tried& tried) {
    return !asked.error || *tried.error <= *asked.error;
  });
  if (exact == best.end())
    throw ComputationError(fmt::format(
        "no choice has an error of {:g}: the least is {:.1e}, with increments of {:g}; {}",
        *asked.error, *best.back().error, best.back().choice.increment,
        trial.spread > *asked.error
            ? fmt::format("paths that differ by 1e-6 at first end {:.1e} apart, whatever is chosen",
                          trial.spread)
            : "smaller ones are not tried"));
  if (!asked.budget) return *exact;
  const double seconds = *asked.budget / thousand;
  if (exact->seconds > seconds)
    throw ComputationError(
        asked.error
            ? fmt::format(
                  "no choice has an error of {:g} within {:g} ms: the fastest takes {:.3g} ms",
                  *asked.error, *asked.budget, thousand * exact->seconds)
            : fmt::format("no choice takes {:g} ms or less: the fastest takes {:.3g} ms",
                          *asked.budget, thousand * exact->seconds));
  if (asked.error) return *exact;
  const auto slower = std::find_if(best.begin(), best.end(),
                                   [&](const Tried& tried) { return tried.seconds > seconds; });
  return *std::prev(slower);
}

Table::Cell cell_of(const std::optional<double>& error) {
  return error ? Table::Cell(*error) : Table::Cell("failed");
}

void run_choose(const ChooseArguments& asked) {
  if (!asked.error && !asked.budget)
    throw InputError("choose: found neither --error nor --budget, expected one of them or both");
  MaterialSource source;
  source.file = asked.material;
  source.base = source.file.parent_path();
  const std::string name = source.file.stem().string() + "_choices";
  if (!is_file_name(name))
    throw InputError(
        fmt::format("{}: found \"{}\", expected {}", asked.material, name, file_name_rule));
  Outputs outputs;
  outputs.add(name, name, {".csv"});
  const OwnFiles own = asked.destination.claim(outputs, files_of(source));
  if (has_inertia(source))
    throw InputError(
        fmt::format("{}: solver.inertia: found true, expected a material that is in equilibrium or "
                    "has drag: the "
                    "error of inertia is by the host's time step",
                    asked.material));
  const Interrupt interrupt;
  Trial trial;
  {
    Progress progress("choose");
    trial = try_choices(source, asked.strain, [&](double share) {
      progress.update(share, "paths of the material");
      Interrupt::check();
    });
  }
  const auto rows_of = [&](const std::vector<Tried>& choices, const std::string& title) {
    Table table(title, {"increment[-]", "tolerance[-]", "viscous_number[-]", "error[-]",
                        "largest_error[-]", "cpu[ms]"});
    for (const Tried& tried : choices) {
      const Choice& choice = tried.choice;
      table.row({fmt::format("{:g}", choice.increment), fmt::format("{:g}", choice.tolerance),
                 fmt::format("{:g}", choice.viscous_number), cell_of(tried.error),
                 cell_of(tried.largest), thousand * tried.seconds});
    }
    return table;
  };
  const auto file = asked.destination.stem(name).string() + ".csv";
  rows_of(trial.tried, "").write(file);
  const std::vector<Tried> best = best_choices(trial);
  rows_of(
      best,
      fmt::format("median error of the stress along {} axes of compression at constant volume to "
                  "{:g} % of strain,\nagainst equilibrium in increments of {:g} % to {:g}, and CPU "
                  "time of a point with the exact tangent;\nchoices to which none as fast is as "
                  "exact",
                  trial.axes, percent * trial.strain, percent * trial.reference.increment,
                  trial.reference.tolerance))
      .print();
  fmt::print("  reference: {:.3g} ms; paths that differ by 1e-6 at first end {:.1e} apart\n",
             thousand * trial.seconds, trial.spread);
  print_choice(trial, chosen(asked, trial, best));
  fmt::print("\nwritten: {}\n", terminal_text(file));
}

}  // namespace

void add_choose_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "choose", "measure error against run time of a material, and print the keys to set");
  auto arguments = std::make_shared<ChooseArguments>();
  command->add_option("MATERIAL", arguments->material, "material description (TOML)")->required();
  command
      ->add_option("--error", arguments->error,
                   "median error of the stress, at most [-]; the fastest choice is printed")
      ->check(above(0));
  command
      ->add_option("--budget", arguments->budget,
                   "most CPU time of a point along one path [ms]; alone: the least error is chosen")
      ->check(above(0));
  command->add_option("--strain", arguments->strain, "strain at the end of the paths [-]")
      ->check(finite_number("in [0.001, 0.1]",
                            [](double value) { return value >= 1e-3 && value <= 0.1; }))
      ->capture_default_str();
  arguments->destination.add_options(*command);
  command->callback([arguments] { run_choose(*arguments); });
}

}  // namespace verification

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
#include <memory>
#include <optional>
#include <string>

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
      best.error, best.largest, thousand * best.seconds, percent * trial.strain);
  fmt::print("# load steps of {:g} % of strain\n[solver]\ntolerance = {:g}\n",
             percent * choice.increment, choice.tolerance);
  if (choice.viscous_number > 0) fmt::print("viscous_number = {:g}\n", choice.viscous_number);
}

// The choice that was asked for. Throws ComputationError where there is none, with the nearest.
const Tried& chosen(const ChooseArguments& asked, const Trial& trial) {
  const Tried* best = nullptr;
  if (asked.error) best = fastest(trial, *asked.error);
  if (asked.budget && !asked.error) best = most_exact(trial, *asked.budget / thousand);
  if (best != nullptr && asked.budget && best->seconds > *asked.budget / thousand)
    throw ComputationError(
        fmt::format("no choice has an error of {:g} within {:g} ms: the fastest takes {:.3g} ms",
                    *asked.error, *asked.budget, thousand * best->seconds));
  if (best != nullptr) return *best;
  if (!asked.error)
    throw ComputationError(
        fmt::format("no choice takes {:g} ms or less: the times are in the table", *asked.budget));
  const auto least =
      std::min_element(trial.tried.begin(), trial.tried.end(), [](const Tried& a, const Tried& b) {
        return std::pair(!a.whole, a.error) < std::pair(!b.whole, b.error);
      });
  throw ComputationError(fmt::format(
      "no choice has an error of {:g}: the least is {:.1e}, with increments of {:g}; {}",
      *asked.error, least->error, least->choice.increment,
      trial.spread > *asked.error
          ? fmt::format("paths that differ by 1e-6 at first end {:.1e} apart, whatever is chosen",
                        trial.spread)
          : "smaller ones are not tried"));
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
                        "largest_error[-]", "cpu[ms]", "whole"});
    for (const Tried& tried : choices) {
      const Choice& choice = tried.choice;
      table.row({fmt::format("{:g}", choice.increment), fmt::format("{:g}", choice.tolerance),
                 fmt::format("{:g}", choice.viscous_number), tried.error, tried.largest,
                 thousand * tried.seconds, tried.whole ? "yes" : "no"});
    }
    return table;
  };
  const auto file = asked.destination.stem(name).string() + ".csv";
  rows_of(trial.tried, "").write(file);
  rows_of(
      best_choices(trial),
      fmt::format("error of the stress along isochoric compression and simple shear to {:g} % of "
                  "strain, against\nequilibrium in increments of {:g} % to {:g}, and CPU time of "
                  "a point with the exact tangent;\nchoices to which none as fast is as exact",
                  percent * trial.strain, percent * trial.reference.increment,
                  trial.reference.tolerance))
      .print();
  fmt::print("  reference: {:.3g} ms; paths that differ by 1e-6 at first end {:.1e} apart\n",
             thousand * trial.seconds, trial.spread);
  print_choice(trial, chosen(asked, trial));
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
                   "largest error of the stress [-]; the fastest choice is printed")
      ->check(above(0));
  command
      ->add_option("--budget", arguments->budget,
                   "most CPU time of a point along one path [ms]; alone: the least error is chosen")
      ->check(above(0));
  command->add_option("--strain", arguments->strain, "strain at the end of the paths [-]")
      ->check(finite_number("in (0, 0.1]", [](double value) { return value > 0 && value <= 0.1; }))
      ->capture_default_str();
  arguments->destination.add_options(*command);
  command->callback([arguments] { run_choose(*arguments); });
}

}  // namespace verification

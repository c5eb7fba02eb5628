// `grainlaw_evidence stability`: extreme cases, each of which must converge or end in a defined way.

#include "evidence/studies/study.hpp"

#include "app/progress.hpp"
#include "evidence/studies/stability/cases.hpp"
#include "evidence/studies/stability/isolated.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <sstream>

namespace verification {
namespace {

using namespace stability;

constexpr double time_limit = 120;  // CPU time of one case; more counts as a hang [s]
constexpr const char* undefined = "UNDEFINED: ";

struct Column {
  const char* name;
  bool printed;  // else in the CSV only
};
constexpr Column columns[] = {{"case", true},
                              {"setting", true},
                              {"increments[-]", true},
                              {"converged[-]", true},
                              {"not_converged[-]", true},
                              {"contacts_lost[-]", true},
                              {"inverted[-]", false},
                              {"step_too_large[-]", false},
                              {"most_halvings[-]", true},
                              {"small_steps_after_failure[-]", false},
                              {"small_steps_done[-]", false},
                              {"evaluations[-]", false},
                              {"subincrements[-]", true},
                              {"history_advanced[-]", true},
                              {"inexact_tangents[-]", false},
                              {"relaxation_steps[-]", true},
                              {"factorisations[-]", true},
                              {"cpu[ms]", true},
                              {"worst_residual[-]", true},
                              {"released_in_jumps[-]", true},
                              {"energy_error[-]", true},
                              {"least_dissipation[-]", false},
                              {"error[-]", true},
                              {"against", false},
                              {"bar", true},
                              {"ends", true}};
using Row = std::vector<Table::Cell>;

std::string ending(const Case& one, const Walked& walked) {
  const auto& [walk, check] = walked;
  if (!walk.violation.empty()) return undefined + walk.violation;
  if (check && one.judged && !(check->error <= check->bar))
    return fmt::format("{}P is {:.3g} off {}", undefined, check->error, check->against);
  if (!walk.gave_up.empty()) {
    return fmt::format("defined: {}: {}", one.skips ? "increments skipped, first" : "given up",
                       walk.gave_up);
  }
  std::string how = "converged";
  if (walk.zero_stress > 0)
    how = fmt::format("defined: CONTACTS_LOST, zero stress at {} increments", walk.zero_stress);
  if (walk.halvings > 0) how += fmt::format(", after up to {} halvings", walk.halvings);
  return how;
}

// Relative to the total absolute work.
Table::Cell per_work(const Course& walk, double energy) {
  return walk.worked ? Table::Cell(energy / walk.total_work) : Table::Cell("");
}

Row row_of(const Case& one, const Walked& walked) {
  const Course& walk = walked.course;
  const std::optional<Check>& check = walked.check;
  const auto failed = [&](grainlaw_status status) -> double {
    const auto found = walk.failures.find(status);
    return found == walk.failures.end() ? 0 : found->second;
  };
  const double evaluations = std::max(1, walk.evaluations);
  const double done = std::max(1, walk.converged + walk.zero_stress);
  return {one.group,
          one.setting,
          static_cast<double>(walk.increments),
          static_cast<double>(walk.converged),
          failed(GRAINLAW_NOT_CONVERGED),
          failed(GRAINLAW_CONTACTS_LOST),
          failed(GRAINLAW_INVERTED),
          failed(GRAINLAW_STEP_TOO_LARGE),
          static_cast<double>(walk.halvings),
          static_cast<double>(walk.small_steps),
          static_cast<double>(walk.small_steps_done),
          static_cast<double>(walk.evaluations),
          static_cast<double>(walk.subincrements),
          static_cast<double>(walk.advancing),
          static_cast<double>(walk.inexact),
          walk.relaxation_steps / evaluations,
          walk.factorisations / evaluations,
          1e3 * walk.cpu / done,
          walk.worst_residual,
          per_work(walk, walk.released),
          per_work(walk, walk.work - walk.stored - walk.dissipated - walk.dragged - walk.released),
          per_work(walk, walk.least_dissipation),
          check ? Table::Cell(check->error) : Table::Cell(""),
          check ? check->against : "",
          one.must_converge ? "must converge" : "",
          ending(one, walked)};
}

Row row_without_walk(const Case& one, const std::string& ends) {
  Row row(std::size(columns), Table::Cell(""));
  row.front() = one.group;
  row[1] = one.setting;
  row[2] = static_cast<double>(one.increments);
  row[row.size() - 2] = one.must_converge ? "must converge" : "";
  row.back() = ends;
  constexpr std::size_t most = 90;  // characters on a terminal
  if (ends.size() > most) row.back().shown = ends.substr(0, most) + "...";
  return row;
}

// A refused material is defined when there is no equilibrium; otherwise this study is wrong.
Row run_case(const Case& one) {
  try {
    std::optional<Material> material;
    try {
      material = one.material();
    } catch (const ComputationError& error) {
      return row_without_walk(one, fmt::format("defined: no material: {}", error.what()));
    }
    return row_of(one, one.walk(*material));
  } catch (const std::exception& error) {
    return row_without_walk(one, undefined + std::string(error.what()));
  }
}

// Commas would end a field of the CSV.
std::string without(std::string text, char unwanted, char other) {
  std::replace(text.begin(), text.end(), unwanted, other);
  return text;
}

std::string to_text(const Row& row) {
  std::string text;
  for (const Table::Cell& cell : row)
    text += without(cell.shown, '\n', ' ') + '\n' + without(cell.full, '\n', ' ') + '\n';
  return text;
}

Row from_text(const std::string& text) {
  std::istringstream stream(text);
  Row row;
  Table::Cell cell("");
  while (std::getline(stream, cell.shown) && std::getline(stream, cell.full)) row.push_back(cell);
  return row;
}

Row run_alone(const Case& one) {
  const Answer answer = run_isolated([&] { return to_text(run_case(one)); }, time_limit);
  if (!answer.failure.empty()) return row_without_walk(one, undefined + answer.failure);
  return from_text(answer.text);
}

void write_tables(const std::vector<Row>& rows, const std::filesystem::path& output) {
  std::vector<std::string> all, printed;
  for (const Column& column : columns) {
    all.emplace_back(column.name);
    if (column.printed) printed.emplace_back(column.name);
  }
  Table full("", all);
  Table shown(
      "stability: every case converges or ends in a defined way. Checked in every evaluation: P, "
      "tangent and measures are finite; after a failure the state has its bytes. Steps and "
      "factorisations per evaluation, CPU per increment; energy over the absolute work: set free "
      "in jumps between equilibria, and what then remains of work - stored - dissipated - by drag "
      "- released",
      printed);
  for (const Row& row : rows) {
    Row narrow;
    for (std::size_t k = 0; k < row.size(); ++k)
      if (columns[k].printed) narrow.push_back(row[k]);
    full.row(row);
    shown.row(narrow);
  }
  shown.print();
  full.write(output / "stability.csv");
}

// Throws ComputationError when a case is undefined.
void summarise(const std::vector<Row>& rows) {
  std::size_t converged = 0;
  std::size_t wrong = 0;
  std::size_t must = 0;
  std::size_t missed = 0;
  for (const Row& row : rows) {
    const std::string& ends = row.back().full;
    if (ends.starts_with("converged")) ++converged;
    if (ends.starts_with(undefined)) ++wrong;
    if (row[row.size() - 2].full.empty()) continue;
    ++must;
    if (!ends.starts_with("converged")) ++missed;
  }
  fmt::print("\n{} cases: {} converged, {} ended as documented, {} undefined\n", rows.size(),
             converged, rows.size() - converged - wrong, wrong);
  if (must > 0) fmt::print("{} of the {} that must converge did\n", must - missed, must);
  std::fflush(stdout);  // before what is said of it on stderr
  if (wrong + missed > 0)
    throw ComputationError(
        fmt::format("stability: {} of {} cases are undefined, {} must converge "
                    "and did not",
                    wrong, rows.size(), missed));
}

void run_study(const StudyOptions& options, const std::string& only, double viscous_number) {
  const std::filesystem::path directory =
      std::filesystem::path(options.output) / "stability_packings";
  std::filesystem::remove_all(directory);
  const PackingStore store(directory, viscous_number);
  MaterialSource yade = options.material(1e-6);
  if (viscous_number > 0) change(yade, "solver", "viscous_number", viscous_number);
  Cases cases;
  add_contact_cases(store, cases);
  add_path_cases(store, yade, cases);
  add_exact_cases(store, cases);
  add_sphere_cases(store, cases);
  std::vector<Row> rows;
  Progress progress("stability");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    Case& one = cases[k];
    const bool by_equilibrium = one.group == "closed form" || one.group == "dilution and back";
    one.judged = viscous_number == 0 || !by_equilibrium;
    if (!(one.group + ": " + one.setting).starts_with(only)) continue;
    progress.update(static_cast<double>(k) / static_cast<double>(cases.size()), one.group);
    rows.push_back(run_alone(one));
  }
  write_tables(rows, options.output);
  summarise(rows);
}

}  // namespace

void add_stability_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto only = std::make_shared<std::string>();
  auto viscous_number = std::make_shared<double>(0);
  CLI::App* command = study.add_subcommand("stability", "extreme cases and how they end");
  command->add_option("--only", *only, "cases whose \"case: setting\" begins like this");
  command->add_option("--viscous-number", *viscous_number,
                      "solver.viscous_number; 0: equilibria [-]");
  command->callback(
      [only, viscous_number, options] { run_study(*options, *only, *viscous_number); });
}

}  // namespace verification

// `grainlaw compare NAME=TABLE...`: finished drained tests of this program and others, compared.

#include "app/bounds.hpp"
#include "app/commands.hpp"
#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/library.hpp"
#include "app/output.hpp"
#include "app/table.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace verification {
namespace {

constexpr double percent = 100;

// A drained test; strains in %, axial compression and dilation positive, stresses in kPa.
struct Curves {
  std::string name;
  bool spheres = false;
  std::vector<double> strain, axial_stress, ratio, volumetric, coordination;

  [[nodiscard]] double stress_at(double at) const { return interpolate(strain, axial_stress, at); }
  [[nodiscard]] double peak() const {
    if (axial_stress.empty()) return std::numeric_limits<double>::quiet_NaN();
    return *std::max_element(axial_stress.begin(), axial_stress.end());
  }
  // Mean axial stress of the rows between two strains.
  [[nodiscard]] double mean_stress(double from, double to) const {
    std::vector<double> inside;
    for (std::size_t k = 0; k < strain.size(); ++k)
      if (strain[k] >= from && strain[k] <= to) inside.push_back(axial_stress[k]);
    if (inside.empty()) return std::numeric_limits<double>::quiet_NaN();
    return std::accumulate(inside.begin(), inside.end(), 0.0) / static_cast<double>(inside.size());
  }
};

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> result = values;
  for (double& value : result) value *= factor;
  return result;
}

// Reads a table of `grainlaw point` or `solve`; else the columns of YADE's tables in
// scenes/reference, which tables of spheres have too.
Curves read_curves(const std::string& name, const std::filesystem::path& path) {
  const CsvTable table = read_csv(path);
  if (table.rows() == 0)
    throw InputError(
        fmt::format("{}: found no row below the header, expected some", path.string()));
  const auto column = [&](const char* wanted, std::string_view unit = "-") {
    if (!table.has(wanted))
      throw InputError(fmt::format("{}: found columns {}, expected {} too", path.string(),
                                   fmt::join(table.names, ","), wanted));
    const std::vector<double>& values = table[wanted];
    const std::string& found =
        table.units[static_cast<std::size_t>(&values - table.columns.data())];
    if (!found.empty() && found != unit)
      throw InputError(fmt::format("{}: {}: found the unit [{}], expected [{}]", path.string(),
                                   wanted, found, unit));
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!std::isfinite(values[k]))
        throw InputError(
            fmt::format("{}: {}: found {} in row {} below the header, expected a number",
                        path.string(), wanted, values[k], k + 1));
    return values;
  };
  const std::vector<double> strain = column("axial_strain");
  const bool own = table.has("sigma22") && !table.has("axial_stress");
  const std::vector<double> axial = own ? column("sigma22", "Pa") : column("axial_stress", "Pa");
  Curves curves{name,
                table.has("sigma33"),
                scaled(strain, percent),
                scaled(axial, own ? -1e-3 : 1e-3),
                own ? column("stress_ratio") : axial,
                scaled(column("volumetric_strain"), percent),
                column("coordination")};
  if (own) return curves;
  const std::vector<double> lateral = column("lateral_stress", "Pa");
  for (std::size_t k = 0; k < table.rows(); ++k) curves.ratio[k] /= lateral[k];
  return curves;
}

void print_stresses(const std::vector<Curves>& runs, const std::filesystem::path& file) {
  std::vector<std::string> columns{"axial_stress[kPa]"};
  for (const Curves& run : runs) columns.push_back(run.name);
  Table table("axial stress", columns);
  const auto line = [&](const std::string& name,
                        const std::function<double(const Curves&)>& value) {
    std::vector<Table::Cell> cells{name};
    for (const Curves& run : runs) cells.push_back(value(run));
    table.row(cells);
  };
  for (const double strain : {0.1, 0.2, 0.5, 1.0, 2.0})
    line(fmt::format("at {:.1f} % axial strain", strain),
         [strain](const Curves& run) { return run.stress_at(strain); });
  line("peak", [](const Curves& run) { return run.peak(); });
  line("mean 6-10 %", [](const Curves& run) { return run.mean_stress(6, 10); });
  table.print();
  table.write(file);
}

// Largest relative difference of axial stress at multiples of 0.1 % of strain, before the peak,
// where round-off does not decide the path.
double largest_difference(const Curves& a, const Curves& b) {
  constexpr double last = 1.0;  // %
  double worst = 0;
  for (int k = 1; k <= static_cast<int>(last * 10 + 0.5); ++k) {
    const double reference = b.stress_at(0.1 * k);
    const double error = std::abs(a.stress_at(0.1 * k) - reference) / reference;
    // NaN of a run that ended before stays.
    worst = std::isnan(worst) || error <= worst ? worst : error;
  }
  return worst;
}

void print_agreement(const Curves& a, const Curves& b) {
  fmt::print("  {:<24} against {:<24} {:.2e} [-]\n", a.name, b.name, largest_difference(a, b));
}

// Allowed differences from the first reference; NaN: not checked.
struct Bounds {
  double stress = std::numeric_limits<double>::quiet_NaN();      // up to 1 % [%]
  double peak = std::numeric_limits<double>::quiet_NaN();        // [%]
  double volumetric = std::numeric_limits<double>::quiet_NaN();  // at 2 % [% of strain]
};

// Prints one line per bound.
void print_verdict(const Curves& run, const Curves& reference, const Bounds& bounds) {
  const auto line = [&](const char* what, double difference, double bound) {
    if (std::isnan(bound)) return;
    fmt::print("  {:<24} {:<38} {:8.3f} %, expected at most {} %: {}\n", run.name, what, difference,
               bound, difference <= bound ? "agrees" : "differs");
  };
  line("axial stress up to 1 % strain", percent * largest_difference(run, reference),
       bounds.stress);
  line("peak of the axial stress", percent * std::abs(run.peak() / reference.peak() - 1),
       bounds.peak);
  constexpr double at = 2;  // %
  line("volumetric strain at 2 % (difference)",
       std::abs(interpolate(run.strain, run.volumetric, at) -
                interpolate(reference.strain, reference.volumetric, at)),
       bounds.volumetric);
}

void draw_comparison(const std::string& title, const std::vector<Curves>& runs,
                     const std::filesystem::path& stem) {
  constexpr std::array<const char*, 8> colours{colour::blue,  colour::orange, colour::green,
                                               colour::black, colour::grey,   colour::purple,
                                               colour::sky,   colour::amber};
  constexpr std::array<Stroke, 5> strokes{Stroke::solid, Stroke::dashed, Stroke::solid,
                                          Stroke::thin, Stroke::thin};
  Figure figure{title, "axial strain [%]", {}};
  const bool spheres =
      std::any_of(runs.begin(), runs.end(), [](const Curves& run) { return run.spheres; });
  Panel ratio{spheres ? "stress ratio axial / lateral [-]" : "stress ratio σ22 / σ11 [-]", {}, 1.5};
  Panel volumetric{"volumetric strain, dilation + [%]"};
  Panel coordination{"coordination number [-]"};
  // Draws the first run last, on top of the others.
  for (std::size_t k = runs.size(); k-- > 0;) {
    const Curves& run = runs[k];
    const char* colour = colours[k % colours.size()];
    const Stroke stroke = strokes[k % strokes.size()];
    ratio.curves.push_back({run.name, run.strain, run.ratio, colour, stroke});
    volumetric.curves.push_back({"", run.strain, run.volumetric, colour, stroke});
    coordination.curves.push_back({"", run.strain, run.coordination, colour, stroke});
  }
  figure.panels = {ratio, volumetric, coordination};
  if (draw(figure, stem)) fmt::print("\npicture: {0}.svg and {0}.png\n", stem.string());
}

struct Arguments {
  std::vector<std::string> tables;   // NAME=TABLE
  std::vector<std::string> against;  // names
  std::string title = "Drained compression";
  std::string name = "comparison";
  Destination destination;
  Bounds bounds;
};

void compare(const Arguments& arguments) {
  std::vector<Curves> runs;
  std::vector<std::filesystem::path> inputs;
  for (const std::string& table : arguments.tables) {
    const std::size_t end = table.rfind('=');
    if (end == std::string::npos || end == 0 || end + 1 == table.size())
      throw InputError(fmt::format("found {}, expected NAME=TABLE", table));
    const std::string name = table.substr(0, end);
    if (std::any_of(runs.begin(), runs.end(), [&](const Curves& run) { return run.name == name; }))
      throw InputError(fmt::format("{}: found the NAME {} twice, expected another", table, name));
    inputs.emplace_back(table.substr(end + 1));
    runs.push_back(read_curves(name, inputs.back()));
  }
  std::vector<const Curves*> references;
  for (const std::string& name : arguments.against) {
    const auto found =
        std::find_if(runs.begin(), runs.end(), [&](const Curves& run) { return run.name == name; });
    if (found == runs.end())
      throw InputError(fmt::format("--against: found {}, expected the name of a table", name));
    references.push_back(&*found);
  }
  if (references.empty()) references.push_back(&runs.back());
  Outputs outputs;
  outputs.add(arguments.name, arguments.name, {".csv"});
  outputs.add_pictures(arguments.name, arguments.name);
  const OwnFiles own = arguments.destination.claim(outputs, inputs);
  const std::filesystem::path stem = arguments.destination.stem(arguments.name);
  print_stresses(runs, stem.string() + ".csv");
  fmt::print("\nlargest relative difference of the axial stress up to 1 % axial strain\n");
  for (const Curves* reference : references)
    for (const Curves& run : runs)
      if (&run != reference) print_agreement(run, *reference);
  const Bounds& bounds = arguments.bounds;
  if (!(std::isnan(bounds.stress) && std::isnan(bounds.peak) && std::isnan(bounds.volumetric))) {
    const Curves& reference = *references.front();
    fmt::print("\nagainst {}\n", reference.name);
    for (const Curves& run : runs)
      if (&run != &reference) print_verdict(run, reference, bounds);
  }
  draw_comparison(arguments.title, runs, stem);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("compare", "compare finished drained tests with each other");
  command->add_option("tables", arguments->tables, "NAME=TABLE.csv of each")->required();
  command->add_option("--against", arguments->against,
                      "NAME of what others are measured by (the last); the first one for verdicts");
  command
      ->add_option("--stress-within", arguments->bounds.stress,
                   "verdict: largest difference of the axial stress up to 1 % strain [%]")
      ->check(at_least(0));
  command
      ->add_option("--peak-within", arguments->bounds.peak, "verdict: difference of the peak [%]")
      ->check(at_least(0));
  command
      ->add_option("--volume-within", arguments->bounds.volumetric,
                   "verdict: difference of the volumetric strain at 2 % strain [%]")
      ->check(at_least(0));
  command->add_option("--title", arguments->title, "of the picture")->capture_default_str();
  command->add_option("--name", arguments->name, "of the files")->capture_default_str();
  arguments->destination.add_options(*command);
  command->callback([arguments] { compare(*arguments); });
}

}  // namespace verification

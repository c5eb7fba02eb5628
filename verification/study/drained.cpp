// `grainlaw study drained`: the drained test of one finite element, of one representative volume
// and of the packing alone, beside YADE's run of the same packing. Reads their tables; runs
// nothing.

#include "study/study.hpp"
#include "study/statistics.hpp"

#include "app/csv.hpp"
#include "app/figure.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace verification {
namespace {

constexpr double percent = 100;

// A drained test; strains in %, axial compression and dilation positive, stresses in kPa.
struct Curves {
  std::string name;
  std::vector<double> strain, axial_stress, ratio, volumetric, coordination;

  [[nodiscard]] double stress_at(double at) const { return interpolate(strain, axial_stress, at); }
  // Mean axial stress of the rows between two strains.
  [[nodiscard]] double mean_stress(double from, double to) const {
    std::vector<double> inside;
    for (std::size_t k = 0; k < strain.size(); ++k)
      if (strain[k] >= from && strain[k] <= to) inside.push_back(axial_stress[k]);
    return average(inside);
  }
};

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> result = values;
  for (double& value : result) value *= factor;
  return result;
}

Curves own_run(const std::string& name, const std::filesystem::path& path) {
  const CsvTable table = read_csv(path);
  return {name,
          scaled(table["axial_strain"], percent),
          scaled(table["sigma22"], -1e-3),
          table["stress_ratio"],
          scaled(table["volumetric_strain"], percent),
          table["coordination"]};
}

Curves yade_run(const std::string& name, const std::filesystem::path& path) {
  const CsvTable table = read_csv(path);
  Curves curves{
      name, scaled(table["axial_strain"], percent),      scaled(table["axial_stress"], 1e-3),
      {},   scaled(table["volumetric_strain"], percent), table["coordination"]};
  for (std::size_t k = 0; k < table.rows(); ++k)
    curves.ratio.push_back(table["axial_stress"][k] / table["lateral_stress"][k]);
  return curves;
}

void print_stresses(const StudyOptions& options, const std::vector<Curves>& runs) {
  std::vector<std::string> columns{"axial_stress[kPa]"};
  for (const Curves& run : runs) columns.push_back(run.name);
  Table table("drained compression at a lateral stress of 100 kPa", columns);
  const auto line = [&](const std::string& name,
                        const std::function<double(const Curves&)>& value) {
    std::vector<Table::Cell> cells{name};
    for (const Curves& run : runs) cells.push_back(value(run));
    table.row(cells);
  };
  for (const double strain : {0.1, 0.2, 0.5, 1.0, 2.0})
    line(fmt::format("at {:.1f} % axial strain", strain),
         [strain](const Curves& run) { return run.stress_at(strain); });
  line("peak", [](const Curves& run) { return largest(run.axial_stress); });
  line("mean 6-10 %", [](const Curves& run) { return run.mean_stress(6, 10); });
  table.print();
  table.write(std::filesystem::path(options.output) / "study_drained.csv");
}

// Largest relative difference of axial stress up to a strain before the peak, where the path does
// not yet depend on round-off, at multiples of 0.1 %.
void print_agreement(const Curves& a, const Curves& b) {
  constexpr double last = 1.0;  // %
  double worst = 0;
  for (int k = 1; k <= static_cast<int>(last * 10 + 0.5); ++k) {
    const double reference = b.stress_at(0.1 * k);
    const double error = std::abs(a.stress_at(0.1 * k) - reference) / reference;
    // NaN, of a run that ended before, stays.
    worst = std::isnan(worst) || error <= worst ? worst : error;
  }
  fmt::print("  {:<24} against {:<24} {:.2e} [-]\n", a.name, b.name, worst);
}

void draw_comparison(const std::vector<Curves>& runs, const std::filesystem::path& stem) {
  // In the order of run_study: own runs first, then YADE's.
  constexpr std::array<const char*, 5> colours{colour::blue, colour::orange, colour::green,
                                               colour::black, colour::grey};
  constexpr std::array<Stroke, 5> strokes{Stroke::solid, Stroke::dashed, Stroke::solid,
                                          Stroke::thin, Stroke::thin};
  Figure figure{
      "Drained biaxial compression of 400 discs, lateral stress 100 kPa", "axial strain [%]", {}};
  Panel ratio{"stress ratio σ22 / σ11 [-]", {}, 1.5, "bottom right"};
  Panel volumetric{"volumetric strain, dilation + [%]", {}, 1, ""};
  Panel coordination{"coordination number [-]", {}, 1, ""};
  // YADE below, so that its lines do not hide ours.
  for (std::size_t k = runs.size(); k-- > 0;) {
    const Curves& run = runs[k];
    ratio.curves.push_back({run.name, run.strain, run.ratio, colours[k], strokes[k]});
    volumetric.curves.push_back({"", run.strain, run.volumetric, colours[k], strokes[k]});
    coordination.curves.push_back({"", run.strain, run.coordination, colours[k], strokes[k]});
  }
  figure.panels = {ratio, volumetric, coordination};
  if (draw(figure, stem)) fmt::print("\npicture: {0}.svg and {0}.png\n", stem.string());
}

struct Arguments {
  std::string element = "drained.csv";
  std::string point = "drained_point.csv";
  std::string dem = "direct_dem.csv";
};

void run_study(const StudyOptions& options, const Arguments& arguments) {
  const std::filesystem::path output = options.output;
  const std::filesystem::path reference = std::filesystem::path(options.scenes) / "reference";
  const std::vector<Curves> runs{own_run("single element", output / arguments.element),
                                 own_run("one RVE", output / arguments.point),
                                 own_run("packing alone", output / arguments.dem),
                                 yade_run("YADE, I = 1e-5", reference / "yade_biax400_I1e-5.csv"),
                                 yade_run("YADE, I = 1e-4", reference / "yade_biax400_I1e-4.csv")};
  print_stresses(options, runs);
  fmt::print("\nlargest relative difference of the axial stress up to 1 % axial strain\n");
  print_agreement(runs[0], runs[1]);
  print_agreement(runs[2], runs[1]);
  for (std::size_t k = 0; k < 3; ++k) print_agreement(runs[k], runs[3]);
  print_agreement(runs[4], runs[3]);
  draw_comparison(runs, output / "drained_comparison");
}

}  // namespace

void add_drained_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("drained", "compare finished drained tests with each other and YADE");
  command->add_option("--element", arguments->element, "table of `grainlaw solve`, in --output")
      ->capture_default_str();
  command->add_option("--point", arguments->point, "table of `grainlaw point`, in --output")
      ->capture_default_str();
  command->add_option("--dem", arguments->dem, "table of the packing alone, in --output")
      ->capture_default_str();
  command->callback([arguments, options] { run_study(*options, *arguments); });
}

}  // namespace verification

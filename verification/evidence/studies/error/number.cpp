// CPU time per evaluation against the number of particles.

#include "evidence/studies/clock.hpp"
#include "evidence/studies/error/error.hpp"
#include "evidence/studies/statistics.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace verification::error_study {
namespace {

constexpr double tolerance = 1e-6;
constexpr int increments = 10;
constexpr int packings = 16;  // of each size: they differ in cost by a factor of two and more
constexpr std::array<int, 7> counts{100, 225, 400, 900, 1600, 3600, 6400};

// The packing of pack400.toml with this many particles, made once and kept in the output directory.
Material packing_of(const StudyOptions& options, int count, int seed) {
  const auto directory = std::filesystem::absolute(options.output) / "packings";
  const std::string stem = (directory / fmt::format("compaction{}_seed{}", count, seed)).string();
  if (!std::filesystem::exists(stem + "_cell.csv")) {
    MaterialSource recipe;
    recipe.file = options.scene("pack400.toml");
    recipe.base = recipe.file.parent_path();
    change(recipe, "packing", "count", count);
    change(recipe, "packing", "seed", seed);
    std::filesystem::create_directories(directory);
    check(grainlaw_state_write_packing(State(make_material(recipe)).get(), stem.c_str()),
          "writing a packing");
  }
  MaterialSource source = options.material(tolerance);
  change(source, "packing", "particles", stem + "_particles.csv");
  change(source, "packing", "contacts", stem + "_contacts.csv");
  change(source, "packing", "cell", stem + "_cell.csv");
  return make_material(source);
}

// Over the increments of one packing.
struct Means {
  double cpu, cpu_exact, median, steps, factorisations;
};

Means measure_packing(const Material& material) {
  std::vector<double> plain, exact, steps, factorisations;
  PointDriver driver(material, {});
  driver.run(drained_segment(-increments * increment_size, drained_pressure, increments),
             [&](const PointStep& step) {
               const Tensor& deformation = step.record.deformation;
               const auto [evaluation, spent] = time_evaluation(step.state, deformation, 0, 500);
               plain.push_back(spent);
               steps.push_back(static_cast<double>(evaluation.report.relaxation_steps));
               factorisations.push_back(evaluation.report.factorisations);
               exact.push_back(
                   time_evaluation(step.state, deformation, GRAINLAW_WANT_TANGENT_EXACT, 500).cpu);
             });
  return {average(plain), average(exact), median(exact), average(steps), average(factorisations)};
}

NumberRow measure_count(const StudyOptions& options, int count) {
  std::vector<double> plain, exact, medians, steps, factorisations;
  for (int seed = 1; seed <= packings; ++seed) {
    const Means means = measure_packing(packing_of(options, count, seed));
    plain.push_back(means.cpu);
    exact.push_back(means.cpu_exact);
    medians.push_back(means.median);
    steps.push_back(means.steps);
    factorisations.push_back(means.factorisations);
  }
  return {static_cast<double>(count), packings,         average(plain),          average(exact),
          standard_error(exact),      average(medians), standard_error(medians), average(steps),
          average(factorisations)};
}

// Exponent of cpu = c N^exponent by least squares of the logarithms, with its error from the errors
// of the rows.
struct Exponent {
  double value, error;

  Exponent(const std::vector<NumberRow>& rows, double NumberRow::*cpu,
           double NumberRow::*error_of) {
    double centre = 0, spread = 0, sum = 0, variance = 0;
    for (const NumberRow& row : rows)
      centre += std::log(row.particles) / static_cast<double>(rows.size());
    for (const NumberRow& row : rows) {
      const double lever = std::log(row.particles) - centre;
      const double relative = row.*error_of / row.*cpu;
      spread += lever * lever;
      sum += lever * std::log(row.*cpu);
      variance += lever * lever * relative * relative;
    }
    value = sum / spread;
    error = std::sqrt(variance) / spread;
  }
};

}  // namespace

std::vector<NumberRow> study_numbers(const StudyOptions& options, int largest_count) {
  constexpr double bar = 1.5;
  std::vector<NumberRow> rows;
  Table table(
      fmt::format(
          "CPU per evaluation against the number of particles: mean of the first {} "
          "increments of 0.1 % of the drained path, tolerance {:.0e} [-], generator "
          "compaction, seeds 1, 2, ...; standard_error: over packings; median: of a packing's "
          "increments, with the exact tangent, mean over packings",
          increments, tolerance),
      {"particles[-]", "packings[-]", "cpu[ms]", "cpu_with_exact_tangent[ms]", "standard_error[ms]",
       "median[ms]", "standard_error_of_median[ms]", "relaxation_steps[-]", "factorisations[-]"});
  Progress progress("particle numbers");
  for (const int count : counts) {
    if (count > largest_count) break;
    progress.update(static_cast<double>(rows.size()) / static_cast<double>(counts.size()),
                    fmt::format("{} x {}", packings, count));
    const NumberRow row = measure_count(options, count);
    table.row({row.particles, row.packings, row.cpu, row.cpu_exact, row.error, row.median,
               row.median_error, row.steps, row.factorisations});
    rows.push_back(row);
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "error_number.csv");
  Table fit("exponent of the particle number in the CPU time with the exact tangent",
            {"of", "from[-]", "to[-]", "exponent[-]", "standard_error[-]", "bar[-]", "met"});
  const Exponent mean(rows, &NumberRow::cpu_exact, &NumberRow::error);
  const Exponent middle(rows, &NumberRow::median, &NumberRow::median_error);
  const auto add = [&](const char* of, const Exponent& exponent) {
    fit.row({of, rows.front().particles, rows.back().particles, exponent.value, exponent.error, bar,
             exponent.value <= bar ? "yes" : "no"});
  };
  add("mean", mean);
  add("median", middle);
  fit.print();
  fit.write(std::filesystem::path(options.output) / "error_exponent.csv");
  draw_numbers(options, rows, mean.value);
  return rows;
}

}  // namespace verification::error_study

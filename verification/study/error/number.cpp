// CPU time per evaluation against the number of particles.

#include "study/clock.hpp"
#include "study/error/error.hpp"
#include "study/statistics.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace verification::error_study {
namespace {

constexpr double tolerance = 1e-6;
constexpr int increments = 10;
constexpr std::array counts{100, 225, 400, 900, 1600, 3600, 6400};

// The packing of pack400.toml with this many particles, made once and kept in the output directory.
Material packing_of(const StudyOptions& options, int count) {
  const auto directory = std::filesystem::absolute(options.output) / "packings";
  const std::string stem = (directory / fmt::format("compaction{}", count)).string();
  if (!std::filesystem::exists(stem + "_cell.csv")) {
    MaterialSource recipe;
    recipe.file = options.scene("pack400.toml");
    recipe.base = recipe.file.parent_path();
    change(recipe, "packing", "count", count);
    std::filesystem::create_directories(directory);
    check(grainlaw_state_write_packing(make_state(make_material(recipe)).get(), stem.c_str()),
          "writing a packing");
  }
  MaterialSource source = options.material(tolerance);
  change(source, "packing", "particles", stem + "_particles.csv");
  change(source, "packing", "contacts", stem + "_contacts.csv");
  change(source, "packing", "cell", stem + "_cell.csv");
  return make_material(source);
}

NumberRow measure_count(const Material& material, int count) {
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
  return {static_cast<double>(count), average(plain), average(exact), average(steps),
          average(factorisations)};
}

// Of cpu = c N^exponent by least squares of the logarithms.
double fitted_exponent(const std::vector<NumberRow>& rows) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const NumberRow& row : rows) {
    const double a = std::log(row.particles);
    const double b = std::log(row.cpu_exact);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace

std::vector<NumberRow> study_numbers(const StudyOptions& options, int largest_count) {
  constexpr double bar = 1.5;
  std::vector<NumberRow> rows;
  Table table(
      fmt::format("CPU per evaluation against the number of particles: mean of the first {} "
                  "increments of 0.1 % of the drained path, tolerance {:.0e} [-], generator "
                  "compaction, seed 1",
                  increments, tolerance),
      {"particles[-]", "cpu[ms]", "cpu_with_exact_tangent[ms]", "relaxation_steps[-]",
       "factorisations[-]"});
  Progress progress("particle numbers");
  for (const int count : counts) {
    if (count > largest_count) break;
    progress.update(static_cast<double>(rows.size()) / static_cast<double>(counts.size()),
                    fmt::format("{}", count));
    const NumberRow row = measure_count(packing_of(options, count), count);
    table.row({row.particles, row.cpu, row.cpu_exact, row.steps, row.factorisations});
    rows.push_back(row);
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "error_number.csv");
  const double exponent = fitted_exponent(rows);
  Table fit("exponent of the particle number in the CPU time with the exact tangent",
            {"from[-]", "to[-]", "exponent[-]", "bar[-]", "met"});
  fit.row({rows.front().particles, rows.back().particles, exponent, bar,
           exponent <= bar ? "yes" : "no"});
  fit.print();
  fit.write(std::filesystem::path(options.output) / "error_exponent.csv");
  draw_numbers(options, rows, exponent);
  return rows;
}

}  // namespace verification::error_study

// `grainlaw_evidence spheres`: CPU time of an increment of spheres over their number, at equilibrium
// and without jumps (solver.viscous_time), with and without the exact tangent.

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/cpu_time.hpp"
#include "app/progress.hpp"
#include "app/table.hpp"

#include <grainlaw/grainlaw.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace verification {
namespace {

constexpr double increment = 0.001;
constexpr double lateral_share = 0.4;  // of the axial strain, near constant stress before the peak

grainlaw::Material spheres(int count, double viscous_time) {
  return grainlaw::Material::parse(fmt::format(R"(dimension = 3
[packing]
generator = "compaction"
count = {}
radii = [3e-3, 6e-3]
seed = 1
pressure = 1e5
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5463
[solver]
tolerance = 1e-8
viscous_time = {}
)",
                                               count, viscous_time),
                                   ".");
}

struct Cost {
  std::vector<double> plain, exact;  // [ms]
  std::vector<double> steps, factorisations;
  int failed = 0;
};

// Triaxial compression in steps of 0.1 %.
Cost cost_of(const grainlaw::Material& material, int increments) {
  grainlaw::State state(material);
  Cost cost;
  std::array<double, 9> P{};
  std::array<double, 81> A{};
  for (int k = 1; k <= increments; ++k) {
    const double strain = increment * k;
    const double lateral = 1 + lateral_share * strain;
    const std::array<double, 9> F{lateral, 0, 0, 0, lateral, 0, 0, 0, 1 - strain};
    const double start = cpu_seconds();
    const auto plain = state.evaluate(F, P);
    const double between = cpu_seconds();
    const auto exact = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A);
    const double end = cpu_seconds();
    if (plain.status != GRAINLAW_OK || exact.status != GRAINLAW_OK) {
      ++cost.failed;
      if (exact.status != GRAINLAW_OK) break;
    }
    constexpr double ms = 1e3;
    cost.plain.push_back(ms * (between - start));
    cost.exact.push_back(ms * (end - between));
    cost.steps.push_back(static_cast<double>(plain.report.relaxation_steps));
    cost.factorisations.push_back(plain.report.factorisations);
    state.commit();
  }
  return cost;
}

void run_study(const StudyOptions& options, const std::vector<int>& counts, int increments) {
  constexpr std::array<double, 2> times{0, 100};
  Table table(fmt::format("one evaluation of a 0.1 % increment, the first {} of triaxial "
                          "compression, tolerance 1e-08 [-], one thread; power: of the number, "
                          "against the fewest",
                          increments),
              {"spheres", "viscous_time[-]", "cpu[ms]", "cpu_with_tangent[ms]", "power[-]",
               "relaxation_steps[-]", "newton_steps[-]", "failed[-]"});
  Progress progress("spheres");
  std::array<double, times.size()> least{};  // of the fewest [ms]
  for (std::size_t c = 0; c < counts.size(); ++c) {
    for (std::size_t t = 0; t < times.size(); ++t) {
      progress.update(static_cast<double>(times.size() * c + t) /
                          static_cast<double>(times.size() * counts.size()),
                      fmt::format("{} spheres", counts[c]));
      const Cost cost = cost_of(spheres(counts[c], times[t]), increments);
      const double exact = average(cost.exact);
      if (c == 0) least[t] = exact;
      const double power = c == 0 ? 0
                                  : std::log(exact / least[t]) /
                                        std::log(static_cast<double>(counts[c]) / counts[0]);
      table.row({fmt::format("{}", counts[c]), fmt::format("{:g}", times[t]), average(cost.plain),
                 exact, power, average(cost.steps), average(cost.factorisations),
                 static_cast<double>(cost.failed)});
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres.csv");
  table.print();
}

}  // namespace

void add_spheres_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    std::vector<int> counts{200, 500, 1000, 2000, 4000};
    int increments = 10;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("spheres", "CPU time over the number of spheres");
  command->add_option("--counts", arguments->counts, "spheres, ascending")->capture_default_str();
  command->add_option("--increments", arguments->increments, "of 0.1 % each")
      ->capture_default_str();
  command->callback(
      [arguments, options] { run_study(*options, arguments->counts, arguments->increments); });
}

}  // namespace verification

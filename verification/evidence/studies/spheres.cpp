// `grainlaw_evidence spheres`: CPU time of an increment of spheres over their number, and how exact their
// tangents are, at equilibrium and without jumps (solver.viscous_time).

#include "evidence/studies/features/cost.hpp"
#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/cpu_time.hpp"
#include "app/progress.hpp"
#include "app/table.hpp"

#include <grainlaw/grainlaw.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace verification {
namespace {

constexpr double increment = 0.001;
constexpr double lateral_share = 0.4;  // of the axial strain, near constant stress before the peak

grainlaw::Material spheres(int count, double viscous_time, double tolerance) {
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
tolerance = {}
viscous_time = {}
)",
                                               count, tolerance, viscous_time),
                                   ".");
}

using Tensor3 = std::array<double, 9>;
using Tangent3 = std::array<double, 81>;

// After so many increments of triaxial compression, or of simple shear.
Tensor3 deformation_after(int increments, bool shear = false) {
  const double strain = increment * increments;
  if (shear) return {1, 0, strain, 0, 1, 0, 0, 0, 1};
  const double lateral = 1 + lateral_share * strain;
  return {lateral, 0, 0, 0, lateral, 0, 0, 0, 1 - strain};
}

struct Cost {
  std::vector<double> plain, exact;  // [ms]
  std::vector<double> steps, factorisations;
  int failed = 0;
  double state = 0;  // committed and trial [B]
};

// At the end of a path: committed there, with a trial beside. The thread has all it needs.
double state_bytes(const grainlaw::Material& material, const Tensor3& end, const Tensor3& beyond) {
  const double before = heap_bytes();
  grainlaw::State state(material);
  Tensor3 P{};
  if (state.evaluate(end, P).status == GRAINLAW_OK) state.commit();
  static_cast<void>(state.evaluate(beyond, P));
  return heap_bytes() - before;
}

// Triaxial compression in steps of 0.1 %.
Cost cost_of(const grainlaw::Material& material, int increments) {
  grainlaw::State state(material);
  Cost cost;
  Tensor3 P{};
  Tangent3 A{};
  for (int k = 1; k <= increments; ++k) {
    const Tensor3 F = deformation_after(k);
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
  cost.state = state_bytes(material, deformation_after(1), deformation_after(2));
  return cost;
}

// Of the exact tangent against central differences, the best of several steps; NaN where one fails, and
// where the report says that the tangent is not exact.
double tangent_error(grainlaw::State& state, const Tensor3& F) {
  Tensor3 P{};
  Tangent3 A{};
  const auto found = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A);
  if (found.status != GRAINLAW_OK || found.report.tangent_exact == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    double error = 0;
    double size = 0;
    for (std::size_t k = 0; k < F.size(); ++k) {
      Tensor3 above{}, below{};
      for (const double sign : {1.0, -1.0}) {
        Tensor3 moved = F;
        moved[k] += sign * step;
        if (state.evaluate(moved, sign > 0 ? above : below).status != GRAINLAW_OK) {
          return std::numeric_limits<double>::quiet_NaN();
        }
      }
      for (std::size_t m = 0; m < F.size(); ++m) {
        const double difference = (above[m] - below[m]) / (2 * step);
        error += std::pow(A[F.size() * m + k] - difference, 2);
        size += std::pow(difference, 2);
      }
    }
    least = std::min(least, std::sqrt(error / size));
  }
  return least;
}

struct TangentErrors {
  std::vector<double> of_exact;
  int states = 0;
};

TangentErrors tangent_errors(const grainlaw::Material& material, bool shear, int increments) {
  grainlaw::State state(material);
  TangentErrors errors;
  for (int k = 1; k <= increments; ++k) {
    const Tensor3 F = deformation_after(k, shear);
    const double error = tangent_error(state, F);
    if (std::isfinite(error)) errors.of_exact.push_back(error);
    ++errors.states;
    Tensor3 P{};
    if (state.evaluate(F, P).status != GRAINLAW_OK) break;
    state.commit();
  }
  return errors;
}

void check_tangents(const StudyOptions& options, int increments) {
  Table table(fmt::format("exact tangent against central differences after each of {} increments, "
                          "tolerance 1e-11 [-], the best of three steps",
                          increments),
              {"spheres", "viscous_time[-]", "path", "median[-]", "largest[-]", "above_1e-6[-]",
               "not_exact[-]"});
  for (const int count : {60, 200, 500}) {
    for (const double time : {0.0, 100.0}) {
      const auto material = spheres(count, time, 1e-11);
      for (const bool shear : {false, true}) {
        const auto [errors, states] = tangent_errors(material, shear, increments);
        const double largest = errors.empty() ? 0 : *std::ranges::max_element(errors);
        const auto above = std::ranges::count_if(errors, [](double error) { return error > 1e-6; });
        table.row({fmt::format("{}", count), fmt::format("{:g}", time),
                   shear ? "shear" : "triaxial", median(errors), largest,
                   static_cast<double>(above), states - static_cast<double>(errors.size())});
      }
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres_tangent.csv");
  table.print();
}

void measure_cost(const StudyOptions& options, const std::vector<int>& counts, int increments) {
  constexpr std::array<double, 2> times{0, 100};
  Table table(fmt::format("one evaluation of a 0.1 % increment, the first {} of triaxial "
                          "compression, tolerance 1e-08 [-], one thread; power: of the number, "
                          "against the fewest",
                          increments),
              {"spheres", "viscous_time[-]", "cpu[ms]", "cpu_with_tangent[ms]", "power[-]",
               "relaxation_steps[-]", "newton_steps[-]", "failed[-]", "state[B/sphere]"});
  Progress progress("spheres");
  std::array<double, times.size()> least{};  // of the fewest [ms]
  for (std::size_t c = 0; c < counts.size(); ++c) {
    for (std::size_t t = 0; t < times.size(); ++t) {
      progress.update(static_cast<double>(times.size() * c + t) /
                          static_cast<double>(times.size() * counts.size()),
                      fmt::format("{} spheres", counts[c]));
      const Cost cost = cost_of(spheres(counts[c], times[t], 1e-8), increments);
      const double exact = average(cost.exact);
      if (c == 0) least[t] = exact;
      const double power = c == 0 ? 0
                                  : std::log(exact / least[t]) /
                                        std::log(static_cast<double>(counts[c]) / counts[0]);
      table.row({fmt::format("{}", counts[c]), fmt::format("{:g}", times[t]), average(cost.plain),
                 exact, power, average(cost.steps), average(cost.factorisations),
                 static_cast<double>(cost.failed), cost.state / counts[c]});
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres.csv");
  table.print();
}

// YADE's 500 spheres.
grainlaw::Material reference(const StudyOptions& options, double tolerance, double viscous_time) {
  return grainlaw::Material::parse(
      fmt::format(R"(dimension = 3
[packing]
particles = "spheres500_particles.csv"
contacts = "spheres500_contacts.csv"
cell = "spheres500_cell.csv"
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5463024898437905
[solver]
tolerance = {}
viscous_time = {}
)",
                  tolerance, viscous_time),
      options.scene("../../tests/data/spheres500.toml").parent_path().string());
}

// What an increment takes with YADE 2023.02a on one core of a Zen 3 [ms], by its stress error: as it is used
// (damping 0.2, half the critical step), with the best setting found, and to 1e-8.
struct Peer {
  const char* name;
  double error, cpu;
};
constexpr std::array<Peer, 3> yade{
    {{"as used", 4e-5, 153}, {"best setting", 2.5e-4, 32}, {"to 1e-8", 1e-8, 2780}}};

// Isochoric increments of 0.1 %, each from the state that was solved to 1e-11.
void measure_error(const StudyOptions& options) {
  constexpr int increments = 20;
  Table table(
      "stress error and CPU time of an increment of 500 spheres of YADE's, medians of 20 isochoric "
      "increments of 0.1 %; over YADE's time for an error as small, measured elsewhere",
      {"viscous_time[-]", "tolerance[-]", "stress_error[-]", "cpu[ms]", "cpu_with_tangent[ms]",
       "yade_as_used/cpu[-]", "yade_best/cpu[-]", "yade_1e-8/cpu_with_tangent[-]"});
  for (const double time : {0.0, 100.0}) {
    const auto exact = reference(options, 1e-11, time);
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
      const auto coarse = reference(options, tolerance, time);
      grainlaw::State lead(exact);
      grainlaw::State state(coarse);
      std::vector<double> errors, plain, with_tangent;
      for (int k = 1; k <= increments; ++k) {
        const double axial = 1 - increment * k;
        const double lateral = 1 / std::sqrt(axial);
        const Tensor3 F{lateral, 0, 0, 0, lateral, 0, 0, 0, axial};
        Tensor3 right{}, P{};
        Tangent3 A{};
        if (lead.evaluate(F, right).status != GRAINLAW_OK) break;
        const double start = cpu_seconds();
        if (state.evaluate(F, P).status != GRAINLAW_OK) break;
        const double between = cpu_seconds();
        if (state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A).status != GRAINLAW_OK) break;
        plain.push_back(1e3 * (between - start));
        with_tangent.push_back(1e3 * (cpu_seconds() - between));
        double error = 0;
        double size = 0;
        for (std::size_t m = 0; m < 9; ++m) {
          error += std::pow(P[m] - right[m], 2);
          size += std::pow(right[m], 2);
        }
        errors.push_back(std::sqrt(error / size));
        lead.commit();
        state.load(lead.save());
      }
      const double cpu = median(plain);
      const double exact_cpu = median(with_tangent);
      const double error = median(errors);
      const auto ratio = [&](const Peer& peer, double own) -> Table::Cell {
        if (error > peer.error && peer.error > 1e-8) return std::string{};
        if (peer.error <= 1e-8 && tolerance > 1e-8) return std::string{};
        return peer.cpu / own;
      };
      table.row({fmt::format("{:g}", time), fmt::format("{:g}", tolerance), error, cpu, exact_cpu,
                 ratio(yade[0], cpu), ratio(yade[1], cpu), ratio(yade[2], exact_cpu)});
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres_error.csv");
  table.print();
}

}  // namespace

void add_spheres_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    std::vector<int> counts{200, 500, 1000, 2000, 4000};
    int increments = 10;
    int states = 20;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("spheres", "CPU time over the number of spheres, exact tangents");
  command->add_option("--counts", arguments->counts, "spheres, ascending")->capture_default_str();
  command->add_option("--increments", arguments->increments, "of 0.1 % each")
      ->capture_default_str();
  command->add_option("--states", arguments->states, "tangents of each path")
      ->capture_default_str();
  command->callback([arguments, options] {
    check_tangents(*options, arguments->states);
    measure_error(*options);
    measure_cost(*options, arguments->counts, arguments->increments);
  });
}

}  // namespace verification

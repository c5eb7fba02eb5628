// `grainlaw_evidence ensemble`: drained compression of several packings of one recipe, as a mean with
// its standard error, beside the same ensemble run with YADE.

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/csv.hpp"
#include "app/jobs.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace verification {
namespace {

// One packing's answers.
struct Member {
  long seed = 0;
  double void_ratio = 0;         // at the start [-]
  double stress_half = 0;        // axial stress at 0.5 % [kPa], compression positive
  double stress_one = 0;         // at 1 % [kPa]
  double peak = 0;               // [kPa]
  double residual = 0;           // mean over 6-10 % [kPa]
  double volumetric_strain = 0;  // at 10 %, dilation positive [%]
  std::string failure;
};

Member run_member(const StudyOptions& options, long seed, int steps) {
  Member member;
  member.seed = seed;
  MaterialSource source;
  source.file = options.scene("pack400.toml");
  source.base = source.file.parent_path();
  change(source, "packing", "seed", seed);
  change(source, "solver", "start", std::string("trial"));  // see scenes/drained_point.toml
  try {
    const Material material = make_material(source);
    PointDriver driver(material, study_options());
    std::vector<double> strain{0};
    std::vector<double> stress{-1e-3 * driver.record().cauchy(1, 1)};
    std::vector<double> late;
    member.void_ratio = driver.record().void_ratio;
    driver.run(drained_segment(-0.1, drained_pressure, steps), [&](const PointStep& step) {
      strain.push_back(step.record.axial_strain());
      stress.push_back(-1e-3 * step.record.cauchy(1, 1));
      if (strain.back() >= 0.06) late.push_back(stress.back());
    });
    member.stress_half = interpolate(strain, stress, 0.005);
    member.stress_one = interpolate(strain, stress, 0.01);
    member.peak = largest(stress);
    member.residual = average(late);
    member.volumetric_strain = 100 * driver.record().volumetric_strain();
  } catch (const ComputationError& error) {
    member.failure = error.what();
  }
  return member;
}

std::vector<Member> run_members(const StudyOptions& options, int count, int steps, int threads) {
  std::vector<Member> members(static_cast<std::size_t>(count));
  run_jobs(members.size(), threads, [&](std::size_t k) {
    const Member& member = members[k] = run_member(options, static_cast<long>(k) + 1, steps);
    tell(fmt::format(
        "packing {} of {}: {}\n", k + 1, count,
        member.failure.empty() ? fmt::format("peak {:.1f} kPa", member.peak) : member.failure));
  });
  return members;
}

struct Quantity {
  const char* name;
  double Member::*value;
  double yade_mean;
  double yade_deviation;  // over its eight packings
};
// Eight packings of the same recipe run with YADE 2023.02a; see verification/scenes/reference.
constexpr std::array<Quantity, 6> quantities{{
    {"void ratio at the start [-]", &Member::void_ratio, 0.1746, 0.0029},
    {"axial stress at 0.5 % [kPa]", &Member::stress_half, 213.2, 2.7},
    {"axial stress at 1 % [kPa]", &Member::stress_one, 269.3, 8.9},
    {"peak axial stress [kPa]", &Member::peak, 294.6, 14.5},
    {"mean axial stress 6-10 % [kPa]", &Member::residual, 208.7, 9.9},
    {"volumetric strain at 10 % [%]", &Member::volumetric_strain, 3.95, 0.52},
}};
constexpr double yade_packings = 8;

void run_study(const StudyOptions& options, int count, int steps, int threads) {
  const std::vector<Member> members = run_members(options, count, steps, threads);
  Table each("packings", {"seed[-]", "void_ratio[-]", "stress_0.5[kPa]", "stress_1[kPa]",
                          "peak[kPa]", "mean_6_10[kPa]", "volumetric_strain[%]"});
  std::vector<Member> good;
  for (const Member& m : members) {
    if (!m.failure.empty()) {
      fmt::print("seed {}: left out: {}\n", m.seed, m.failure);
      continue;
    }
    good.push_back(m);
    each.row({static_cast<double>(m.seed), m.void_ratio, m.stress_half, m.stress_one, m.peak,
              m.residual, m.volumetric_strain});
  }
  each.print();
  each.write(std::filesystem::path(options.output) / "study_ensemble_packings.csv");

  Table table(
      fmt::format("drained compression, mean of {} packings against YADE's eight; s.e. is the "
                  "standard error of a mean",
                  good.size()),
      {"quantity", "mean", "s.d.", "s.e.", "yade_mean", "yade_s.d.", "yade_s.e.",
       "over_yade_s.e.[-]", "over_both_s.e.[-]", "within_two_of_both"});
  for (const Quantity& quantity : quantities) {
    std::vector<double> values;
    for (const Member& member : good) values.push_back(member.*quantity.value);
    const double deviation = standard_deviation(values);
    const double error = deviation / std::sqrt(static_cast<double>(values.size()));
    const double yade_error = quantity.yade_deviation / std::sqrt(yade_packings);
    const double difference = average(values) - quantity.yade_mean;
    const double combined = difference / std::hypot(error, yade_error);
    table.row({quantity.name, average(values), deviation, error, quantity.yade_mean,
               quantity.yade_deviation, yade_error, difference / yade_error, combined,
               std::abs(combined) <= 2 ? "yes" : "no"});
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_ensemble.csv");
}

}  // namespace

void add_ensemble_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    int packings = 8;
    int steps = 100;
    int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("ensemble", "drained tests of several packings");
  command->add_option("--packings", arguments->packings, "seeds 1 to this number [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--steps", arguments->steps, "increments to 10 % axial strain [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "packings run at once [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([arguments, options] {
    run_study(*options, arguments->packings, arguments->steps, arguments->threads);
  });
}

}  // namespace verification

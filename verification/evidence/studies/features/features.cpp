// `grainlaw_evidence features`: what every feature costs, in time and in memory, against the same
// material and increments without it.

#include "evidence/studies/features/feature_list.hpp"

#include "app/bounds.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace verification {
namespace {

using namespace features;

constexpr double bytes_allowed = 250;  // of one state, per disc

// With and without in turn, so that both meet the machine as it is at the time.
template <int D>
std::array<Cost, 2> costs(const Feature<D>& feature) {
  constexpr int rounds = 7;
  CostMeasurement<D> with(feature.with, feature.path, feature.use);
  CostMeasurement<D> without(feature.without, feature.path, {});
  for (int round = 0; round < rounds; ++round) {
    with.again();
    without.again();
  }
  return {with.cost(), without.cost()};
}

// Tables to study_features_time`name`.csv and study_features_memory`name`.csv; returns the most
// bytes a particle.
template <int D>
double measure_all(const StudyOptions& options, const std::vector<Feature<D>>& all,
                   const Setting& setting, const std::string& name) {
  Table time(
      fmt::format("cpu time per evaluation, {} {}, increments of 0.1 %, tolerance {:.0e} "
                  "[-], one thread; calls are counted with the evaluation they follow",
                  setting.count, D == 2 ? "discs" : "spheres", setting.tolerance),
      {"feature", "cpu_with[ms]", "cpu_without[ms]", "difference[ms]", "ratio[-]", "steps_with[-]",
       "steps_without[-]", "factorisations_with[-]", "factorisations_without[-]"});
  Table memory("memory",
               {"feature", "state_with[B]", "state_without[B]", "per_particle_with[B]",
                "per_particle_without[B]", "saved_with[B]", "saved_without[B]", "thread_with[B]",
                "thread_without[B]", "material_with[B]", "material_without[B]"});
  Progress progress("features");
  double most = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Feature<D>& feature = all[k];
    progress.update(static_cast<double>(k) / static_cast<double>(all.size()), feature.name);
    const auto [with, without] = costs(feature);
    time.row({feature.name, with.cpu, without.cpu, with.cpu - without.cpu, with.cpu / without.cpu,
              with.relaxation_steps, without.relaxation_steps, with.factorisations,
              without.factorisations});
    const double per_particle = with.state / with.particles;
    const double per_particle_without = without.state / without.particles;
    memory.row({feature.name, with.state, without.state, per_particle, per_particle_without,
                with.saved, without.saved, with.workspace, without.workspace, with.material,
                without.material});
    most = std::max({most, per_particle, per_particle_without});
  }
  const std::filesystem::path output = options.output;
  time.print();
  time.write(output / ("study_features_time" + name + ".csv"));
  memory.print();
  memory.write(output / ("study_features_memory" + name + ".csv"));
  return most;
}

void run_study(const StudyOptions& options, int dimension, const Setting& asked) {
  Setting setting = asked;
  if (dimension != 3) {
    if (asked.count == 0) setting.count = 400;
    const double most = measure_all<2>(options, of_discs(options, setting), setting, "");
    fmt::print("\nlargest state: {:.0f} bytes per disc, {} {:g}\n", most,
               most <= bytes_allowed ? "within" : "ABOVE", bytes_allowed);
  }
  if (dimension != 2) {
    if (asked.count == 0) setting.count = 200;
    const double most = measure_all<3>(options, of_spheres(options, setting), setting, "_spheres");
    fmt::print("\nlargest state: {:.0f} bytes per sphere\n", most);
  }
}

}  // namespace

void add_features_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    int dimension = 0;
    Setting setting{.count = 0};
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("features", "time and memory of every feature, on and off");
  command->add_option("--dimension", arguments->dimension, "2: discs alone, 3: spheres; 0: both")
      ->check(CLI::IsMember({0, 2, 3}))
      ->capture_default_str();
  command
      ->add_option("--count", arguments->setting.count, "particles [-]; 0: 400 discs, 200 spheres")
      ->check(at_least(0));
  command->add_option("--tolerance", arguments->setting.tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command
      ->add_option("--viscous-number", arguments->setting.viscous_number,
                   "of both; 0: equilibria [-]")
      ->capture_default_str();
  command->callback(
      [arguments, options] { run_study(*options, arguments->dimension, arguments->setting); });
}

}  // namespace verification

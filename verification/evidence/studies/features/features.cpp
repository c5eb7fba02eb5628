// `grainlaw_evidence features`: what every feature costs, in time and in memory, against the same
// material and increments without it.

#include "evidence/studies/features/cost.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/output.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace verification {
namespace {

constexpr double increment = 1e-3;     // of the axial strain [-]
constexpr double bytes_allowed = 250;  // of one state, per particle

struct Feature {
  std::string name;
  MaterialSource with, without;
  std::vector<Increment> path;
  Usage use;  // with it; without it nothing is used
};

// Axial compression with the lateral expansion of a drained test, in `tries` iterates each.
std::vector<Increment> compression(int increments, int tries) {
  std::vector<Increment> path;
  for (int k = 1; k <= increments; ++k) {
    Increment tried;
    for (int t = tries - 1; t >= 0; --t) {
      const double strain = increment * (k + (t == 0 ? 0 : 0.1 * std::pow(10, -(tries - 1 - t))));
      tried.push_back(Tensor{{1 + 0.4 * strain, 0}, {0, 1 - strain}});
    }
    path.push_back(tried);
  }
  return path;
}

// All round, in smaller steps: without friction anything else makes the packing flow.
std::vector<Increment> isotropic_compression(int increments) {
  std::vector<Increment> path;
  for (int k = 1; k <= increments; ++k)
    path.push_back({Tensor::Identity() * (1 - 0.1 * increment * k)});
  return path;
}

// A packing of `count` discs compacted without friction, so that it suits every law; its files.
MaterialSource base_material(const StudyOptions& options, int count, double tolerance,
                             double viscous_number) {
  MaterialSource recipe;
  recipe.file = options.scene("pack400.toml");
  recipe.base = recipe.file.parent_path();
  change(recipe, "packing", "count", count);
  const auto stem = output_stem(options.output, fmt::format("study_features_{}", count));
  State state(make_material(recipe));
  check(grainlaw_state_write_packing(state.get(), stem.c_str()), "writing the packing");

  const auto file = [&](const char* what) {
    return std::filesystem::absolute(stem.string() + what).string();
  };
  MaterialSource source;
  source.base = ".";
  source.changes.insert("dimension", 2);
  change(source, "packing", "particles", file("_particles.csv"));
  change(source, "packing", "cell", file("_cell.csv"));
  change(source, "contact", "law", "frictional");
  change(source, "contact", "young", 6e8);
  change(source, "contact", "ratio", 0.8);
  change(source, "contact", "friction", std::tan(0.5));
  change(source, "solver", "tolerance", tolerance);
  if (viscous_number > 0) change(source, "solver", "viscous_number", viscous_number);
  return source;
}

template <class Value>
MaterialSource changed(MaterialSource source, const char* table, const char* key, Value value) {
  change(source, table, key, value);
  return source;
}

// Another law on the same discs.
MaterialSource with_law(MaterialSource source, toml::table contact) {
  source.changes.insert_or_assign("contact", std::move(contact));
  return source;
}

MaterialSource with_rolling(const MaterialSource& source) {
  return changed(source, "contact", "rolling", toml::table{{"ratio", 1.0}, {"friction", 0.1}});
}

// Bonds of some mean contact forces.
MaterialSource with_bonds(const MaterialSource& source, double strength) {
  auto bonded = changed(source, "contact", "law", "bonded");
  change(bonded, "contact", "bond",
         toml::table{{"normal_strength", strength},
                     {"tangential_strength", strength},
                     {"bending_stiffness", 20.0},
                     {"bending_strength", 2e-3 * strength}});
  return bonded;
}

void take_all_measures(const State& state) {
#define GRAINLAW_X(name, value, count, text) static_cast<void>(state.measure(name));
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
}

// Periodic to left and right, discs that F moves below, a rigid row above; the vertical stress is
// prescribed and F22 found.
MaterialSource layer(MaterialSource source) {
  change(source, "boundary", "type", "mixed");
  const auto side = [&](const char* name, toml::table rules) {
    change(source, "boundary", name, std::move(rules));
  };
  side("left", toml::table{{"x", "P"}});
  side("right", toml::table{{"x", "P"}});
  side("bottom", toml::table{{"x", "D"}});
  side("top", toml::table{{"x", "D"}, {"y", "T"}, {"row", "rigid"}});
  side("stress", toml::table{{"P22", -1e5}});
  return source;
}

// Into a copy: loading drops the trial.
void save_and_load(const State& state) {
  State copy = state;
  copy.load(state.save());
}

std::vector<Feature> features(const StudyOptions& options, int count, double tolerance,
                              double viscous_number) {
  constexpr int increments = 10;
  const auto path = compression(increments, 1);
  const MaterialSource base = base_material(options, count, tolerance, viscous_number);
  const auto smooth = changed(base, "contact", "friction", 0.0);
  const auto locked = changed(base, "contact", "rotation", false);
  const auto frame = changed(base, "boundary", "type", "frame-p");
  const auto trial = changed(base, "solver", "start", "trial");
  const auto compressive = with_law(base, toml::table{{"law", "compressive"}, {"young", 6e8}});
  const auto hertz = with_law(
      base,
      toml::table{
          {"law", "hertz"}, {"shear_modulus", 9e9}, {"poisson", 0.2}, {"friction", std::tan(0.5)}});
  const std::string vtk = output_stem(options.output, "study_features.vtp").string();
  std::vector<Feature> all{
      {"friction, isotropic path", locked, smooth, isotropic_compression(increments), {}},
      {"rotation", base, locked, path, {}},
      {"compressive against friction 0",
       compressive,
       smooth,
       isotropic_compression(increments),
       {}},
      {"rolling resistance", with_rolling(base), base, path, {}},
      {"Hertz-Mindlin against linear", hertz, base, path, {}},
      {"bonds that hold", with_bonds(base, 1e6), base, path, {}},
      {"bonds that break", with_bonds(base, 100), base, path, {}},
      {"exact tangent", base, base, path, {GRAINLAW_WANT_TANGENT_EXACT, {}}},
      {"elastic tangent", base, base, path, {GRAINLAW_WANT_TANGENT_ELASTIC, {}}},
      {"perturbed tangent", base, base, path, {GRAINLAW_WANT_TANGENT_PERTURBED, {}}},
      {"frame-p", frame, base, path, {}},
      {"frame-d", changed(base, "boundary", "type", "frame-d"), base, path, {}},
      {"frame-t", changed(base, "boundary", "type", "frame-t"), base, path, {}},
      {"frame-t, exact tangent",
       changed(base, "boundary", "type", "frame-t"),
       changed(base, "boundary", "type", "frame-t"),
       path,
       {GRAINLAW_WANT_TANGENT_EXACT, {}}},
      {"layer under P22", layer(base), base, path, {}},
      {"start = trial, 3 iterates", trial, base, compression(increments, 3), {}},
      {"all measures", base, base, path, {0, take_all_measures}},
      {"VTK file", base, base, path, {0, [vtk](const State& state) { state.write_vtk(vtk); }}},
      {"save", base, base, path, {0, [](const State& state) { static_cast<void>(state.save()); }}},
      {"save, clone and load", base, base, path, {0, save_and_load}}};

  // The servo takes a hundred times the steps: a small packing and a loose tolerance.
  constexpr int servo_count = 100;
  constexpr double servo_tolerance = 1e-3;
  auto direct = base_material(options, servo_count, servo_tolerance, 0);
  change(direct, "boundary", "type", "frame-p");
  auto servo = direct;
  change(servo, "boundary", "method", "servo");
  change(direct, "solver", "method", "published");
  all.push_back({"servo (100 discs)", servo, direct, compression(1, 1), {}});
  return all;
}

// With and without in turn, so that both meet the machine as it is at the time.
std::array<Cost, 2> costs(const Feature& feature) {
  constexpr int rounds = 7;
  CostMeasurement with(feature.with, feature.path, feature.use);
  CostMeasurement without(feature.without, feature.path, {});
  for (int round = 0; round < rounds; ++round) {
    with.again();
    without.again();
  }
  return {with.cost(), without.cost()};
}

void run_study(const StudyOptions& options, int count, double tolerance, double viscous_number) {
  Table time(
      fmt::format("cpu time per evaluation, {} discs, increments of 0.1 %, tolerance {:.0e} "
                  "[-], one thread; calls are counted with the evaluation they follow",
                  count, tolerance),
      {"feature", "cpu_with[ms]", "cpu_without[ms]", "difference[ms]", "ratio[-]", "steps_with[-]",
       "steps_without[-]", "factorisations_with[-]", "factorisations_without[-]"});
  Table memory("memory",
               {"feature", "state_with[B]", "state_without[B]", "per_particle_with[B]",
                "per_particle_without[B]", "saved_with[B]", "saved_without[B]", "thread_with[B]",
                "thread_without[B]", "material_with[B]", "material_without[B]"});
  Progress progress("features");
  double most = 0;
  const auto all = features(options, count, tolerance, viscous_number);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Feature& feature = all[k];
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
  time.print();
  time.write(std::filesystem::path(options.output) / "study_features_time.csv");
  memory.print();
  memory.write(std::filesystem::path(options.output) / "study_features_memory.csv");
  fmt::print("\nlargest state: {:.0f} bytes per particle, {} {:g}\n", most,
             most <= bytes_allowed ? "within" : "ABOVE", bytes_allowed);
}

}  // namespace

void add_features_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    int count = 400;
    double tolerance = 1e-6;
    double viscous_number = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      study.add_subcommand("features", "time and memory of every feature, on and off");
  command->add_option("--count", arguments->count, "discs [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--tolerance", arguments->tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command->add_option("--viscous-number", arguments->viscous_number, "of both; 0: equilibria [-]")
      ->capture_default_str();
  command->callback([arguments, options] {
    run_study(*options, arguments->count, arguments->tolerance, arguments->viscous_number);
  });
}

}  // namespace verification

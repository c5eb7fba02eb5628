#include "evidence/studies/reach/packings.hpp"

#include "app/material.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification::reach {
namespace {

constexpr double mean_radius = 5e-3;         // of the recipe [m]
constexpr double pressure = 100e3;           // of the recipe [Pa]
constexpr double thickness = 0.1;            // of the recipe [m]
constexpr long more_seeds = 9;               // tried where one leads to no packing
constexpr double stiffest_compaction = 1e4;  // kn/p; beyond, few seeds lead to a packing [-]

// kn = young x mean radius for two discs of mean radius.
double young(double stiffness) {
  return std::min(stiffness, stiffest_compaction) * pressure * thickness / mean_radius;
}

Material read(const PackingRecipe& recipe, const std::string& name, double young, double friction) {
  MaterialSource source;
  source.base = recipe.directory;
  source.changes.insert_or_assign("dimension", 2);
  change(source, "packing", "particles", name + "_particles.csv");
  change(source, "packing", "contacts", name + "_contacts.csv");
  change(source, "packing", "cell", name + "_cell.csv");
  change(source, "contact", "law", "frictional");
  change(source, "contact", "young", young);
  change(source, "contact", "ratio", 0.8);
  change(source, "contact", "friction", friction);
  change(source, "solver", "tolerance", recipe.tolerance);
  return make_material(source);
}

void write(const State& state, const PackingRecipe& recipe, const std::string& name) {
  std::filesystem::create_directories(recipe.directory);
  state.write_packing((recipe.directory / name).string());
}

bool is_kept(const PackingRecipe& recipe, const std::string& name) {
  return recipe.keep && std::filesystem::exists(recipe.directory / (name + "_particles.csv"));
}

// Compacts the packing of the first seed that leads to one, and returns its name.
std::string compact(const PackingRecipe& recipe, double stiffness) {
  const auto name_of = [&](long seed) {
    return fmt::format("discs{}_seed{}_{:.0e}", recipe.count, seed, stiffness);
  };
  for (long seed = recipe.seed; seed <= recipe.seed + more_seeds; ++seed)
    if (is_kept(recipe, name_of(seed))) return name_of(seed);
  MaterialSource source;
  source.file = recipe.scene;
  source.base = recipe.scene.parent_path();
  change(source, "packing", "count", recipe.count);
  change(source, "packing", "pressure", pressure);
  change(source, "contact", "young", young(stiffness));
  change(source, "solver", "tolerance", recipe.tolerance);
  for (long seed = recipe.seed;; ++seed) {
    change(source, "packing", "seed", seed);
    try {
      State state(make_material(source));
      write(state, recipe, name_of(seed));
      return name_of(seed);
    } catch (const ComputationError& error) {
      fmt::print("kn/p = {:.0e}, seed {}: {}\n", stiffness, seed, error.what());
      if (seed == recipe.seed + more_seeds) throw;
    }
  }
}

// The pressure under F = stretch x I and its derivative [Pa].
struct Pressure {
  double value;
  double slope;

  Pressure(const Evaluation& evaluation, double stretch) {
    const Tensor deformation = stretch * Tensor::Identity();
    const Tangent spatial = cauchy_tangent(evaluation.stress, evaluation.tangent, deformation);
    value = -0.5 * cauchy_stress(evaluation.stress, deformation).trace();
    slope = -0.5 * (spatial(0, 0) + spatial(0, 3) + spatial(3, 0) + spatial(3, 3));
  }
};

// Expands a packing until its pressure has fallen to the share of what it was.
void unload(State& state, double share) {
  constexpr double largest_decrease = 0.2;  // of the pressure in one increment
  constexpr double accuracy = 0.01;
  constexpr double least_decrease = 1e-6;  // where smaller ones would be needed it is given up
  constexpr int most_increments = 1000;
  double stretch = 1;
  Pressure now(evaluate(state, Tensor::Identity(), GRAINLAW_WANT_TANGENT_EXACT), stretch);
  const double target = share * now.value;
  double decrease = largest_decrease;
  for (int count = 0;
       count < most_increments && decrease > least_decrease && now.value > (1 + accuracy) * target;
       ++count) {
    const double wanted = std::max(target, (1 - decrease) * now.value);
    const double next = stretch + (wanted - now.value) / now.slope;
    const Tensor deformation = next * Tensor::Identity();
    const Evaluation result = evaluate(state, deformation, GRAINLAW_WANT_TANGENT_EXACT);
    const bool good =
        result.status == GRAINLAW_OK && Pressure(result, next).value > (1 - accuracy) * target;
    if (good) {
      state.commit();
      stretch = next;
      now = Pressure(result, next);
    }
    decrease = good ? std::min(2 * decrease, largest_decrease) : 0.5 * decrease;
  }
  state.revert();
  if (now.value > (1 + accuracy) * target)
    throw ComputationError(
        fmt::format("unloading a packing ended at {:.3g} Pa instead of {:.3g}", now.value, target));
}

}  // namespace

std::string make_packing(const PackingRecipe& recipe, double stiffness) {
  if (stiffness <= stiffest_compaction) return compact(recipe, stiffness);
  const std::string from = compact(recipe, stiffest_compaction);
  const std::string name = fmt::format("{}_to_{:.0e}", from, stiffness);
  if (is_kept(recipe, name)) return name;
  State state(read(recipe, from, young(stiffness), 0));
  unload(state, stiffest_compaction / stiffness);
  write(state, recipe, name);
  return name;
}

Material read_packing(const PackingRecipe& recipe, const std::string& name, double stiffness,
                      double friction, double factor) {
  return read(recipe, name, factor * young(stiffness), friction);
}

}  // namespace verification::reach

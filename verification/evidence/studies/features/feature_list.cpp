#include "evidence/studies/features/feature_list.hpp"

#include "app/output.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification::features {
namespace {

constexpr double increment = 1e-3;  // of the axial strain [-]
constexpr int increments = 10;
const double friction = std::tan(0.5);

// Axial compression with the lateral expansion of a drained test, in `tries` iterates each.
template <int D>
std::vector<Increment<D>> compression(int steps, int tries) {
  std::vector<Increment<D>> path;
  for (int k = 1; k <= steps; ++k) {
    Increment<D> tried;
    for (int t = tries - 1; t >= 0; --t) {
      const double strain = increment * (k + (t == 0 ? 0 : 0.1 * std::pow(10, -(tries - 1 - t))));
      TensorOf<D> deformation = TensorOf<D>::Identity() * (1 + 0.4 * strain);
      deformation(D - 1, D - 1) = 1 - strain;
      tried.push_back(deformation);
    }
    path.push_back(tried);
  }
  return path;
}

// All round, in smaller steps: without friction anything else makes the packing flow.
template <int D>
std::vector<Increment<D>> isotropic_compression() {
  std::vector<Increment<D>> path;
  for (int k = 1; k <= increments; ++k)
    path.push_back({TensorOf<D>::Identity() * (1 - 0.1 * increment * k)});
  return path;
}

// What the laws of a dimension are given: moduli, and strengths of some mean contact forces.
template <int D>
struct Laws {
  static constexpr double young = D == 2 ? 6e8 : 1e8;            // [Pa]
  static constexpr double shear_modulus = D == 2 ? 9e9 : 1.3e9;  // [Pa]
  static constexpr double bending = D == 2 ? 20.0 : 2.0;         // [N m/rad]
  static constexpr double weak = D == 2 ? 100.0 : 8.0;           // [N]
};

// A packing compacted without friction, so that it suits every law; its files.
template <int D>
MaterialSource base_material(const StudyOptions& options, const Setting& setting) {
  MaterialSource recipe;
  recipe.file = options.scene(D == 2 ? "pack400.toml" : "spheres200.toml");
  recipe.base = recipe.file.parent_path();
  change(recipe, "packing", "count", setting.count);
  const auto stem = output_stem(
      options.output, fmt::format("study_features_{}{}", setting.count, D == 2 ? "" : "_spheres"));
  State state(make_material(recipe, D));
  check(grainlaw_state_write_packing(state.get(), stem.c_str()), "writing the packing");

  const auto file = [&](const char* what) {
    return std::filesystem::absolute(stem.string() + what).string();
  };
  MaterialSource source;
  source.base = ".";
  source.changes.insert("dimension", D);
  change(source, "packing", "particles", file("_particles.csv"));
  change(source, "packing", "cell", file("_cell.csv"));
  change(source, "contact", "law", "frictional");
  change(source, "contact", "young", Laws<D>::young);
  change(source, "contact", "ratio", 0.8);
  change(source, "contact", "friction", friction);
  change(source, "solver", "tolerance", setting.tolerance);
  if (setting.viscous_number > 0)
    change(source, "solver", "viscous_number", setting.viscous_number);
  return source;
}

template <class Value>
MaterialSource changed(MaterialSource source, const char* table, const char* key, Value value) {
  change(source, table, key, value);
  return source;
}

// Another law on the same particles.
MaterialSource with_law(MaterialSource source, toml::table contact) {
  source.changes.insert_or_assign("contact", std::move(contact));
  return source;
}

template <int D>
MaterialSource with_rolling(const MaterialSource& source) {
  toml::table rolling{{"ratio", 1.0}, {"friction", 0.1}};
  if (D == 3) {
    rolling.insert("twisting_ratio", 1.0);
    rolling.insert("twisting_friction", 0.1);
  }
  return changed(source, "contact", "rolling", std::move(rolling));
}

template <int D>
MaterialSource with_bonds(const MaterialSource& source, double strength) {
  auto bonded = changed(source, "contact", "law", "bonded");
  toml::table bond{{"normal_strength", strength},
                   {"tangential_strength", strength},
                   {"bending_stiffness", Laws<D>::bending},
                   {"bending_strength", 2e-3 * strength}};
  if (D == 3) {
    bond.insert("torsion_stiffness", Laws<D>::bending);
    bond.insert("torsion_strength", 2e-3 * strength);
  }
  change(bonded, "contact", "bond", std::move(bond));
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

// What both dimensions have, on one base.
template <int D>
std::vector<Feature<D>> of_laws(const MaterialSource& base) {
  const auto path = compression<D>(increments, 1);
  const auto all_round = isotropic_compression<D>();
  const auto smooth = changed(base, "contact", "friction", 0.0);
  const auto locked = changed(base, "contact", "rotation", false);
  const auto compressive =
      with_law(base, toml::table{{"law", "compressive"}, {"young", Laws<D>::young}});
  const auto hertz = with_law(base, toml::table{{"law", "hertz"},
                                                {"shear_modulus", Laws<D>::shear_modulus},
                                                {"poisson", 0.2},
                                                {"friction", friction}});
  return {{"friction, isotropic path", locked, smooth, all_round, {}},
          {"rotation", base, locked, path, {}},
          {"compressive against friction 0", compressive, smooth, all_round, {}},
          {"rolling resistance", with_rolling<D>(base), base, path, {}},
          {"Hertz-Mindlin against linear", hertz, base, path, {}},
          {"bonds that hold", with_bonds<D>(base, 1e6), base, path, {}},
          {"bonds that break", with_bonds<D>(base, Laws<D>::weak), base, path, {}},
          {"exact tangent", base, base, path, {GRAINLAW_WANT_TANGENT_EXACT, {}}},
          {"elastic tangent", base, base, path, {GRAINLAW_WANT_TANGENT_ELASTIC, {}}},
          {"perturbed tangent", base, base, path, {GRAINLAW_WANT_TANGENT_PERTURBED, {}}}};
}

template <int D>
void add_uses(const MaterialSource& base, const std::string& vtk, std::vector<Feature<D>>& all) {
  const auto path = compression<D>(increments, 1);
  const auto trial = changed(base, "solver", "start", "trial");
  for (Feature<D>& feature : std::vector<Feature<D>>{
           {"start = trial, 3 iterates", trial, base, compression<D>(increments, 3), {}},
           {"all measures", base, base, path, {0, take_all_measures}},
           {"VTK file", base, base, path, {0, [vtk](const State& state) { state.write_vtk(vtk); }}},
           {"save",
            base,
            base,
            path,
            {0, [](const State& state) { static_cast<void>(state.save()); }}},
           {"save, clone and load", base, base, path, {0, save_and_load}}})
    all.push_back(std::move(feature));
}

}  // namespace

std::vector<Feature<2>> of_discs(const StudyOptions& options, const Setting& setting) {
  const MaterialSource base = base_material<2>(options, setting);
  const auto path = compression<2>(increments, 1);
  auto all = of_laws<2>(base);
  const auto frame_t = changed(base, "boundary", "type", "frame-t");
  for (const char* type : {"frame-p", "frame-d", "frame-t"})
    all.push_back({type, changed(base, "boundary", "type", type), base, path, {}});
  all.push_back(
      {"frame-t, exact tangent", frame_t, frame_t, path, {GRAINLAW_WANT_TANGENT_EXACT, {}}});
  all.push_back({"layer under P22", layer(base), base, path, {}});
  add_uses<2>(base, output_stem(options.output, "study_features.vtp").string(), all);

  // The servo takes a hundred times the steps: a small packing and a loose tolerance.
  auto direct = base_material<2>(options, {.count = 100, .tolerance = 1e-3});
  change(direct, "boundary", "type", "frame-p");
  auto servo = direct;
  change(servo, "boundary", "method", "servo");
  change(direct, "solver", "method", "published");
  all.push_back({"servo (100 discs)", servo, direct, compression<2>(1, 1), {}});
  return all;
}

std::vector<Feature<3>> of_spheres(const StudyOptions& options, const Setting& setting) {
  const MaterialSource base = base_material<3>(options, setting);
  auto all = of_laws<3>(base);
  add_uses<3>(base, output_stem(options.output, "study_features_spheres.vtp").string(), all);
  return all;
}

}  // namespace verification::features

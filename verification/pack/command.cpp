// `grainlaw pack RECIPE.toml`: make a packing, say what it is, and write it.

#include "app/commands.hpp"
#include "app/history.hpp"
#include "app/material.hpp"
#include "app/output.hpp"
#include "pack/picture.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

namespace verification {
namespace {

struct PackArguments {
  std::string recipe;
  std::string output = ".";
  std::string name;
  std::optional<long> seed;
  bool vtk = false;
};

void print_packing(const grainlaw_state* state) {
  const double void_ratio = measure_scalar(state, GRAINLAW_VOID_RATIO);
  const std::vector<double> sigma = measure(state, GRAINLAW_CAUCHY_STRESS);
  const auto line = [](const char* what, double value, const char* unit) {
    fmt::print("  {:<34} {:>12.6g} {}\n", what, value, unit);
  };
  line("particles", measure_scalar(state, GRAINLAW_PARTICLES), "[-]");
  line("touching contacts", measure_scalar(state, GRAINLAW_CONTACTS), "[-]");
  line("void ratio", void_ratio, "[-]");
  line("volume fraction", 1 / (1 + void_ratio), "[-]");
  line("coordination, all particles", measure_scalar(state, GRAINLAW_COORDINATION), "[-]");
  line("coordination, without rattlers", measure_scalar(state, GRAINLAW_COORDINATION_NO_RATTLERS),
       "[-]");
  line("fabric anisotropy", measure_scalar(state, GRAINLAW_ANISOTROPY), "[-]");
  line("mean overlap", measure_scalar(state, GRAINLAW_MEAN_OVERLAP) * 1e6, "um");
  line("stress 11 (tension positive)", sigma[0] / 1e3, "kPa");
  line("stress 12", sigma[1] / 1e3, "kPa");
  line("stress 21", sigma[2] / 1e3, "kPa");
  line("stress 22", sigma[3] / 1e3, "kPa");
}

void run_pack(const PackArguments& arguments) {
  MaterialSource source;
  source.file = arguments.recipe;
  source.base = source.file.parent_path();
  const SceneFile recipe(source.file);
  if (arguments.seed) {
    if (!recipe.content["packing"]["generator"])
      throw InputError(arguments.recipe + ": --seed needs a [packing] with a generator");
    change(source, "packing", "seed", *arguments.seed);
  }
  const Material material = make_material(source);
  const State state = make_state(material);
  const auto stem = output_stem(
      arguments.output, arguments.name.empty() ? source.file.stem().string() : arguments.name);
  check(grainlaw_state_write_packing(state.get(), stem.c_str()), "writing the packing");
  if (arguments.vtk)
    check(grainlaw_state_write_vtk(state.get(), (stem.string() + ".vtp").c_str()),
          "writing the particles");
  fmt::print("{}\n", stem.filename().string());
  print_packing(state.get());
  draw_packing(
      stem.string(), stem,
      fmt::format("{}: void ratio {:.4f}, coordination {:.3f}; bar width: normal force",
                  stem.filename().string(), measure_scalar(state.get(), GRAINLAW_VOID_RATIO),
                  measure_scalar(state.get(), GRAINLAW_COORDINATION)));
  fmt::print("wrote {0}_particles.csv, _contacts.csv, _cell.csv, .svg, .png{1}\n", stem.string(),
             arguments.vtk ? ", .vtp" : "");
}

}  // namespace

void add_pack_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("pack", "make a packing from a recipe and write it");
  auto arguments = std::make_shared<PackArguments>();
  command->add_option("RECIPE", arguments->recipe, "material description (TOML)")->required();
  command->add_option("--output", arguments->output, "directory for the results")
      ->capture_default_str();
  command->add_option("--name", arguments->name, "name of the results; default: of the recipe");
  command->add_option("--seed", arguments->seed, "seed of the generator, instead of the recipe's");
  command->add_flag("--vtk", arguments->vtk, "also write the particles for ParaView (.vtp)");
  command->callback([arguments] { run_pack(*arguments); });
}

}  // namespace verification

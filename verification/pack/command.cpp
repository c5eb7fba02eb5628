// `grainlaw pack RECIPE.toml`: make a packing, say what it is, and write it.

#include "app/bounds.hpp"
#include "app/commands.hpp"
#include "app/cpu_time.hpp"
#include "app/interrupt.hpp"
#include "app/material.hpp"
#include "app/output.hpp"
#include "app/state_files.hpp"
#include "app/text.hpp"
#include "app/written.hpp"
#include "pack/picture.hpp"
#include "pack/rose.hpp"
#include "pack/written.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace verification {
namespace {

struct PackArguments {
  std::string recipe;
  Destination destination;
  std::string name;
  std::optional<long> seed;
  long seeds = 0;
  bool vtk = false;
};

// One packing, made and written.
struct Made {
  State state;
  PackingStart start;
  std::optional<WrittenPacking> discs;  // none: spheres
  std::filesystem::path stem;
  double seconds;  // of CPU, to make the material

  [[nodiscard]] double scalar(grainlaw_measure what) const {
    return measure_scalar(state.get(), what);
  }
  [[nodiscard]] std::string name() const { return stem.filename().string(); }
  [[nodiscard]] std::size_t boundary() const { return discs ? discs->boundary.size() : 0; }
  [[nodiscard]] double volume_fraction() const { return 1 / (1 + scalar(GRAINLAW_VOID_RATIO)); }
};

std::string name_of(const PackArguments& arguments) {
  const std::string of_recipe = std::filesystem::path(arguments.recipe).stem().string();
  const std::string& name = arguments.name.empty() ? of_recipe : arguments.name;
  if (!is_file_name(name))
    throw InputError(fmt::format("{}: --name: found {}\"{}\", expected {}", arguments.recipe,
                                 arguments.name.empty() ? "nothing, and the recipe is called " : "",
                                 name, file_name_rule));
  return name;
}

MaterialSource source_of(const PackArguments& arguments) {
  MaterialSource source;
  source.file = arguments.recipe;
  source.base = source.file.parent_path();
  return source;
}

Made make(const PackArguments& arguments, std::optional<long> seed) {
  MaterialSource source = source_of(arguments);
  if (seed) change(source, "packing", "seed", *seed);
  const int dimension = dimension_of(source);
  const double start = cpu_seconds();
  std::optional<Material> material;
  try {
    material = make_material(source, dimension);
  } catch (const ComputationError& error) {
    throw ComputationError(
        fmt::format("{}; after {:.2f} s of CPU", error.what(), cpu_seconds() - start));
  }
  const double seconds = cpu_seconds() - start;
  State state(*material);
  const auto stem = arguments.destination.stem(name_of(arguments));
  write_packing(state.get(), stem);
  PackingStart look = measure_start(state.get(), source);
  std::optional<WrittenPacking> discs;
  if (dimension == 2) discs = read_written(stem.string());
  return {std::move(state), std::move(look), std::move(discs), stem, seconds};
}

void print_packing(const Made& made) {
  const std::vector<double> sigma = measure(made.state.get(), GRAINLAW_CAUCHY_STRESS);
  const auto line = [](const char* what, double value, const char* unit) {
    fmt::print("  {:<42} {:>12.6g} {}\n", what, value, unit);
  };
  line("particles", made.start.particles, "[-]");
  if (made.boundary() > 0) {
    line("of them on the boundary", static_cast<double>(made.boundary()), "[-]");
    line("particles, copies of a side counted once", made.scalar(GRAINLAW_PARTICLES), "[-]");
  }
  line("touching contacts, copies counted once", made.scalar(GRAINLAW_CONTACTS), "[-]");
  line("void ratio", made.scalar(GRAINLAW_VOID_RATIO), "[-]");
  line("volume fraction, copies counted once", made.volume_fraction(), "[-]");
  line("coordination, all particles", made.scalar(GRAINLAW_COORDINATION), "[-]");
  line("coordination, without rattlers", made.scalar(GRAINLAW_COORDINATION_NO_RATTLERS), "[-]");
  line("fabric anisotropy", made.scalar(GRAINLAW_ANISOTROPY), "[-]");
  if (made.discs)
    line("its major direction, against axis 1", contact_rose(*made.discs).direction * 180 / M_PI,
         "deg");
  line("mean overlap", made.scalar(GRAINLAW_MEAN_OVERLAP) * 1e6, "um");
  const auto d = static_cast<std::size_t>(made.start.dimension);
  for (std::size_t k = 0; k < d * d; ++k)
    line(fmt::format("stress {}{}{}", k / d + 1, k % d + 1, k == 0 ? " (tension positive)" : "")
             .c_str(),
         sigma[k] / 1e3, "kPa");
  line("CPU time to make it", made.seconds, "s");
}

// One line for each seed, to choose one; each is written as NAME_sSEED.
void compare_seeds(PackArguments arguments, long first) {
  const std::string name = name_of(arguments);
  Outputs outputs;
  for (long seed = first; seed < first + arguments.seeds; ++seed)
    outputs.add_packing(name, fmt::format("{}_s{}", name, seed));
  const OwnFiles own = arguments.destination.claim(outputs, files_of(source_of(arguments)));
  const Interrupt interrupt;
  long failed = 0;
  fmt::print("{:>6} {:>9} {:>9} {:>9} {:>9} {:>11} {:>9} {:>8}\n", "seed", "particles", "boundary",
             "fraction", "coordin.", "no rattlers", "anisotr.", "CPU [s]");
  for (long seed = first; seed < first + arguments.seeds; ++seed) {
    if (Interrupt::signal() != 0) {
      fmt::print("  {} before seed {}\n", Interrupted{Interrupt::signal()}.text(), seed);
      Interrupt::check();
    }
    try {
      arguments.name = fmt::format("{}_s{}", name, seed);
      const Made made = make(arguments, seed);
      fmt::print("{:>6} {:>9} {:>9} {:>9.4f} {:>9.3f} {:>11.3f} {:>9.4f} {:>8.2f}\n", seed,
                 made.start.particles, made.boundary(), made.volume_fraction(),
                 made.scalar(GRAINLAW_COORDINATION), made.scalar(GRAINLAW_COORDINATION_NO_RATTLERS),
                 made.scalar(GRAINLAW_ANISOTROPY), made.seconds);
    } catch (const ComputationError& error) {
      fmt::print("{:>6} {}\n", seed, error.what());
      ++failed;
    }
    std::fflush(stdout);
  }
  if (failed > 0)
    throw ComputationError(fmt::format("{}: {} of {} seeds have no packing, as told beside them",
                                       arguments.recipe, failed, arguments.seeds));
}

void run_pack(const PackArguments& arguments) {
  const SceneFile recipe(arguments.recipe);
  const std::string name = name_of(arguments);
  const auto packing = recipe.content["packing"];
  if ((arguments.seed || arguments.seeds > 0) && !packing["seed"])
    throw InputError(arguments.recipe + ": --seed needs a [packing] with a generator and a seed");
  if (arguments.seeds > 0)
    return compare_seeds(arguments, arguments.seed.value_or(packing["seed"].value_or(1L)));
  Outputs outputs;
  outputs.add_packing(name, name);
  outputs.add_pictures(name, name);
  if (arguments.vtk) outputs.add(name, name, {".vtp"});
  const OwnFiles own = arguments.destination.claim(outputs, files_of(source_of(arguments)));
  const Made made = make(arguments, arguments.seed);
  Written written(made.stem);
  for (const char* end : {"_particles.csv", "_contacts.csv", "_cell.csv"}) written.add(end);
  if (arguments.vtk) {
    write_vtk(made.state.get(), made.stem.string() + ".vtp");
    written.add(".vtp");
  }
  print_start(made.name(), made.start);
  print_packing(made);
  written.add_pictures(draw_packing(made.state.get(), made.stem));
  fmt::print("{}\n", written.text());
}

}  // namespace

void add_pack_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("pack", "make a packing from a recipe and write it");
  auto arguments = std::make_shared<PackArguments>();
  command->add_option("RECIPE", arguments->recipe, "material description (TOML)")->required();
  arguments->destination.add_options(*command);
  command->add_option("--name", arguments->name, "name of the results; default: of the recipe");
  command->add_option("--seed", arguments->seed, "seed of the generator, instead of the recipe's");
  command
      ->add_option("--seeds", arguments->seeds,
                   "compare so many seeds, one line each, written as NAME_sSEED")
      ->check(at_least(1));
  command->add_flag("--vtk", arguments->vtk, "also write the particles for ParaView (.vtp)");
  command->callback([arguments] { run_pack(*arguments); });
}

}  // namespace verification

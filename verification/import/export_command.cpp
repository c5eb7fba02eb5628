// `grainlaw export MATERIAL.toml`: a packing in the form of another program.

#include "app/atomic_file.hpp"
#include "app/commands.hpp"
#include "app/material.hpp"
#include "app/output.hpp"
#include "app/snapshot.hpp"
#include "app/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>

namespace verification {
namespace {

// What the forms need of a packing at F = I. Discs lie at half of their thickness.
struct Exported {
  Snapshot snapshot;
  std::array<double, 9> cell{};  // H row by row [m]
  double density = 0;            // [kg/m3]

  [[nodiscard]] double z(std::size_t p) const {
    return snapshot.spheres() ? snapshot.z[p] : 0.5 * cell[8];
  }
  [[nodiscard]] bool rectangular() const {
    return cell[1] == 0 && cell[2] == 0 && cell[3] == 0 && cell[5] == 0 && cell[6] == 0 &&
           cell[7] == 0;
  }
};

Exported exported(const MaterialSource& source) {
  const State state(make_material(source, dimension_of(source)));
  Exported packing{take_snapshot(state.get()), {}, 0};
  const Snapshot& snapshot = packing.snapshot;
  if (!snapshot.boundary.empty())
    throw InputError(
        fmt::format("{}: found a frame, expected a periodic cell", source.file.string()));
  const std::size_t d = snapshot.spheres() ? 3 : 2;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < d; ++j) packing.cell[3 * i + j] = snapshot.cell[d * i + j];
  if (d == 2)
    packing.cell[8] =
        measure_scalar(state.get(), GRAINLAW_VOLUME) /
        std::abs(snapshot.cell[0] * snapshot.cell[3] - snapshot.cell[1] * snapshot.cell[2]);
  const toml::table material = unfold(source).changes;
  packing.density = material["packing"]["density"].value_or(2650.0);
  return packing;
}

std::string yade_text(const Exported& packing) {
  const auto& h = packing.cell;
  // SpherePack.load knows the first of these lines, ymport.textExt passes over both.
  std::string text = packing.rectangular()
                         ? fmt::format("##PERIODIC:: {} {} {}\n", h[0], h[4], h[8])
                         : fmt::format("##CELL:: {}\n", fmt::join(h, " "));
  const Snapshot& s = packing.snapshot;
  for (std::size_t p = 0; p < s.size(); ++p)
    fmt::format_to(std::back_inserter(text), "{}\t{}\t{}\t{}\n", s.x[p], s.y[p], packing.z(p),
                   s.radius[p]);
  return text;
}

void check_lammps(const Exported& packing) {
  const auto& h = packing.cell;
  if (h[3] != 0 || h[6] != 0 || h[7] != 0 || !(h[0] > 0) || !(h[4] > 0) || !(h[8] > 0))
    throw InputError(
        "--format: found a cell with H21, H31 or H32 other than 0, which LAMMPS has not; "
        "expected yade");
}

std::string lammps_data(const Exported& packing) {
  check_lammps(packing);
  const auto& h = packing.cell;
  const Snapshot& s = packing.snapshot;
  // Discs lie at z = 0 in a box around it.
  const double low = s.spheres() ? 0 : -0.5 * h[8];
  std::string text = fmt::format(
      "Packing of grainlaw\n\n{} atoms\n1 atom types\n\n0 {} xlo xhi\n0 {} ylo yhi\n{} {} zlo "
      "zhi\n",
      s.size(), h[0], h[4], low, low + h[8]);
  if (!packing.rectangular()) text += fmt::format("{} {} {} xy xz yz\n", h[1], h[2], h[5]);
  text += "\nAtoms # sphere\n\n";
  for (std::size_t p = 0; p < s.size(); ++p)
    fmt::format_to(std::back_inserter(text), "{} 1 {} {} {} {} {}\n", p + 1, 2 * s.radius[p],
                   packing.density, s.x[p], s.y[p], s.spheres() ? s.z[p] : 0);
  return text;
}

std::string lammps_dump(const Exported& packing) {
  check_lammps(packing);
  const auto& h = packing.cell;
  const Snapshot& s = packing.snapshot;
  const double low = s.spheres() ? 0 : -0.5 * h[8];
  std::string text = fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\n", s.size());
  if (packing.rectangular()) {
    text +=
        fmt::format("ITEM: BOX BOUNDS pp pp pp\n0 {}\n0 {}\n{} {}\n", h[0], h[4], low, low + h[8]);
  } else {
    const double xy = h[1], xz = h[2], yz = h[5];
    text += fmt::format("ITEM: BOX BOUNDS xy xz yz pp pp pp\n{} {} {}\n{} {} {}\n{} {} {}\n",
                        std::min({0.0, xy, xz, xy + xz}), h[0] + std::max({0.0, xy, xz, xy + xz}),
                        xy, std::min(0.0, yz), h[4] + std::max(0.0, yz), xz, low, low + h[8], yz);
  }
  text += "ITEM: ATOMS id type xu yu zu radius\n";
  for (std::size_t p = 0; p < s.size(); ++p)
    fmt::format_to(std::back_inserter(text), "{} 1 {} {} {} {}\n", p + 1, s.x[p], s.y[p],
                   s.spheres() ? s.z[p] : 0, s.radius[p]);
  return text;
}

struct Form {
  const char* name;
  const char* end;
  std::string (*text)(const Exported&);
};
constexpr std::array<Form, 3> forms{{{"yade", ".txt", yade_text},
                                     {"lammps", ".data", lammps_data},
                                     {"dump", ".dump", lammps_dump}}};

struct ExportArguments {
  std::string material, name, format = "yade";
  Destination destination;
};

void run_export(const ExportArguments& arguments) {
  MaterialSource source;
  source.file = arguments.material;
  source.base = source.file.parent_path();
  const SceneFile file(arguments.material);  // tells whether it is there
  const std::string name = arguments.name.empty() ? source.file.stem().string() : arguments.name;
  for (const Form& form : forms) {
    if (arguments.format != form.name) continue;
    Outputs outputs;
    outputs.add(name, name, {form.end});
    const OwnFiles own = arguments.destination.claim(outputs, files_of(source));
    const std::string path = arguments.destination.stem(name).string() + form.end;
    const Exported packing = exported(source);
    write_file(path, form.text(packing));
    fmt::print("{} {} at F = I; wrote {}\n", packing.snapshot.size(),
               packing.snapshot.spheres() ? "spheres" : "discs", terminal_text(path));
  }
}

}  // namespace

void add_export_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("export", "write the packing of a material for YADE or LAMMPS");
  auto arguments = std::make_shared<ExportArguments>();
  command->add_option("MATERIAL", arguments->material, "material file (TOML)")->required();
  command
      ->add_option("--format", arguments->format,
                   "yade: text for ymport.textExt and, of a rectangular cell, SpherePack.load; "
                   "lammps: data file, atom_style "
                   "sphere; dump")
      ->check(CLI::IsMember({"yade", "lammps", "dump"}))
      ->capture_default_str();
  arguments->destination.add_options(*command);
  command->add_option("--name", arguments->name, "NAME of the result; default: of the material");
  command->callback([arguments] { run_export(*arguments); });
}

}  // namespace verification

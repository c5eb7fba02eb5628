// `grainlaw import FILE`: a packing of another program as three files and a material that refers to them.

#include "app/atomic_file.hpp"
#include "app/bounds.hpp"
#include "app/commands.hpp"
#include "app/material.hpp"
#include "app/output.hpp"
#include "app/scratch.hpp"
#include "app/state_files.hpp"
#include "app/text.hpp"
#include "app/written.hpp"
#include "import/contact_law.hpp"
#include "pack/picture.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace verification {
namespace {

constexpr std::array<const char*, 3> file_ends{"_particles.csv", "_contacts.csv", "_cell.csv"};

// What stands beside NAME_particles.csv belongs to it.
void take_neighbours(ForeignFiles& files) {
  const std::string end = file_ends[0];
  if (!files.particles.ends_with(end)) return;
  const std::string prefix = files.particles.substr(0, files.particles.size() - end.size());
  const auto take = [&](std::string& file, const char* name) {
    if (file.empty() && std::filesystem::is_regular_file(prefix + name)) file = prefix + name;
  };
  take(files.contacts, file_ends[1]);
  take(files.cell, file_ends[2]);
}

// The law of a material file that the command writes, as docs/material.md recommends.
constexpr double recommended_viscous_number = 1e-3;
constexpr const char* law_text =
    "# solver.viscous_number makes a law in time, without jumps; leave it out for equilibrium.\n";

std::string name_of(const ImportArguments& arguments) {
  std::string name = arguments.name;
  if (name.empty()) {
    name = std::filesystem::path(arguments.files.particles).stem().string();
    if (name.ends_with("_particles")) name.erase(name.size() - std::string("_particles").size());
  }
  return name;
}

OwnFiles claim(const ImportArguments& arguments, const std::string& name) {
  const auto& files = arguments.files;
  Outputs outputs;
  outputs.add_packing(name, name);
  outputs.add(name, name, {".toml"});
  outputs.add_pictures(name, name);
  return arguments.destination.claim(
      outputs, {files.particles, files.contacts, files.cell, arguments.material});
}

toml::table packing_table(const std::string& prefix, bool contacts) {
  toml::table table{{"particles", prefix + file_ends[0]}, {"cell", prefix + file_ends[2]}};
  if (contacts) table.insert("contacts", prefix + file_ends[1]);
  return table;
}

// Material by --material, else by the options; without [packing].
MaterialSource description(const ImportArguments& arguments, const ForeignPacking& packing,
                           std::vector<std::string>& notes) {
  MaterialSource source;
  if (!arguments.material.empty()) {
    source.changes = SceneFile(arguments.material).content;
    const int dimension = dimension_of(source);
    if (dimension != packing.dimension)
      throw InputError(fmt::format("{}: dimension: found {}, expected {} as of {}",
                                   arguments.material, dimension, packing.dimension,
                                   arguments.files.particles));
    source.changes.erase("thickness");  // the cell has it
  } else {
    source.changes.insert("dimension", packing.dimension);
    source.changes.insert("contact", contact_table(arguments, packing, notes));
    source.changes.insert("boundary", toml::table{{"type", "periodic-cell"}});
  }
  const auto is_bonded = [](const ForeignContact& contact) { return contact.bonded; };
  if (source.changes["contact"]["law"].value_or(std::string()) != "bonded" &&
      std::any_of(packing.contacts.begin(), packing.contacts.end(), is_bonded))
    throw InputError(fmt::format(
        "{}: found bonds, expected --material with law = \"bonded\", which says what they bear",
        arguments.files.contacts));
  return source;
}

double pressure_of(const std::vector<double>& sigma) {
  return sigma.size() == 9 ? -(sigma[0] + sigma[4] + sigma[8]) / 3 : -0.5 * (sigma[0] + sigma[3]);
}

State equilibrium(MaterialSource& source, const ImportArguments& arguments, int dimension) {
  if (!(arguments.pressure > 0) || source.changes["contact"]["young"].value_or(0.0) == 0)
    return State(make_material(source, dimension));
  // Forces of linear contacts are as their stiffness. Particles that do not press are told below.
  MaterialSource measured = source;
  measured.changes.insert("solver", toml::table{{"contacts_lost", "stress_free"}});
  const State state(make_material(measured, dimension));
  const double now = pressure_of(measure(state.get(), GRAINLAW_CAUCHY_STRESS));
  if (!(now > 0))
    throw InputError(
        fmt::format("{}: --pressure: found particles that do not press on each other, expected "
                    "overlaps; --young "
                    "with a smaller --cell brings them together",
                    arguments.files.particles));
  const double young = 1e8 * arguments.pressure / now;
  source.changes["contact"].as_table()->insert_or_assign("young",
                                                         std::stod(fmt::format("{:.12g}", young)));
  return State(make_material(source, dimension));
}

void print_state(const State& state, const PackingStart& start, const ForeignPacking& packing) {
  const std::vector<double> sigma = measure(state.get(), GRAINLAW_CAUCHY_STRESS);
  const auto line = [](const char* what, const std::string& value, const char* unit) {
    fmt::print("  {:<42} {:>14} {}\n", what, value, unit);
  };
  const auto number = [](double value) { return fmt::format("{:.6g}", value); };
  const auto scalar = [&](grainlaw_measure what) {
    return number(measure_scalar(state.get(), what));
  };
  line("mean pressure", number(start.pressure), "Pa");
  const int d = packing.dimension;
  for (int k = 0; k < d * d; ++k)
    line(fmt::format("stress {}{}{}", k / d + 1, k % d + 1, k == 0 ? " (tension positive)" : "")
             .c_str(),
         fmt::format("{:.9g}", sigma[static_cast<std::size_t>(k)]), "Pa");
  if (packing.has_contacts) {
    const Lattice read = packing.stress();
    double difference = 0, size = 0;
    for (int k = 0; k < d * d; ++k) {
      const double of_file = read[static_cast<std::size_t>(3 * (k / d) + k % d)];
      difference += std::pow(sigma[static_cast<std::size_t>(k)] - of_file, 2);
      size += of_file * of_file;
    }
    line("its difference from the forces in the file",
         fmt::format("{:.2e}", std::sqrt(difference / size)), "of it");
  }
  line(packing.dimension == 3 ? "kn/(p d)" : "kn/(p t)", number(start.stiffness), "-");
  line("void ratio", scalar(GRAINLAW_VOID_RATIO), "-");
  line("contacts", scalar(GRAINLAW_CONTACTS), "-");
  line("coordination, all particles", scalar(GRAINLAW_COORDINATION), "-");
  line("coordination, without rattlers", scalar(GRAINLAW_COORDINATION_NO_RATTLERS), "-");
}

void run_import(ImportArguments arguments) {
  take_neighbours(arguments.files);
  const std::string name = name_of(arguments);
  const OwnFiles own = claim(arguments, name);
  const auto stem = arguments.destination.stem(name);
  const ForeignPacking packing = read_foreign(arguments.files);
  std::vector<std::string> notes = packing.notes;
  MaterialSource source = description(arguments, packing, notes);
  for (const std::string& text : packing.read) fmt::print("read {}\n", text);
  if (!packing.has_contacts)
    fmt::print("found no contacts in a file: those of particles that overlap\n");
  for (const std::string& text : notes) fmt::print("note: {}\n", text);

  const ScratchDirectory scratch;
  const std::string raw = (scratch / "read").string();
  write_foreign(packing, raw);
  source.changes.insert_or_assign("packing", packing_table(raw, packing.has_contacts));
  const State state = equilibrium(source, arguments, packing.dimension);
  write_packing(state.get(), stem);
  const PackingStart start = measure_start(state.get(), source);
  source.changes.insert_or_assign("packing", packing_table(name, true));
  if (arguments.material.empty())
    source.changes.insert("solver", toml::table{{"viscous_number", recommended_viscous_number}});
  std::ostringstream text;
  text << "# Imported from "
       << terminal_text(std::filesystem::path(arguments.files.particles).filename().string())
       << " by grainlaw import.\n"
       << (arguments.material.empty() ? law_text : "") << source.changes << "\n";
  write_file(stem.string() + ".toml", text.str());

  print_state(state, start, packing);
  warn(name, start);
  Written written(stem);
  written.add(".toml");
  for (const char* end : file_ends) written.add(end);
  written.add_pictures(draw_packing(state.get(), stem));
  fmt::print("{}\n", written.text());
}

// A unit by its name or by what it is in SI.
void add_unit(CLI::App& command, const char* name, const char* text, Quantity quantity,
              double& unit) {
  command.add_option_function<std::string>(
      name,
      [quantity, name, &unit](const std::string& told) {
        const std::optional<double> named = in_si(told, quantity);
        unit = named ? *named : number_in(told).value_or(0);
        if (!(unit > 0))
          throw InputError(fmt::format("{}: found {}, expected a number > 0 or {}", name, told,
                                       expected_unit(quantity)));
      },
      text);
}

}  // namespace

void add_import_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "import",
      "read a packing of YADE, LAMMPS or any table, bring it to equilibrium and write it");
  auto a = std::make_shared<ImportArguments>();
  command
      ->add_option("FILE", a->files.particles,
                   "text export of YADE, dump or data file of LAMMPS, or a table with x, y, (z,) r")
      ->required();
  command->add_option("--contacts", a->files.contacts,
                      "table or local dump with i, j and fn, ftx, fty, (ftz,) or fx, fy, (fz) [N]; "
                      "default: NAME_contacts.csv beside NAME_particles.csv");
  command->add_option(
      "--cell", a->files.cell,
      "LX,LY[,LZ] or H row by row [m], a table with H00, H01, ..., or box; default: of FILE, "
      "or NAME_cell.csv");
  command->add_option("--columns", a->files.columns, "of FILE by name or place: x=1,y=2,r=radius");
  command->add_option("--contact-columns", a->files.contact_columns,
                      "of --contacts: i=1,j=2,fn=force");
  command->add_option("--separator", a->files.separator,
                      "between columns; default: ; , or blanks, as found");
  command->add_option("--dimension", a->files.dimension, "2 or 3; default: 2 where all z are one")
      ->check(CLI::IsMember({2, 3}));
  add_unit(*command, "--length-unit", "of columns without one in their header: mm, or 1e-3 [m]",
           Quantity::length, a->files.units.length);
  add_unit(*command, "--force-unit", "of such columns: kN, or 1e3 [N]", Quantity::force,
           a->files.units.force);
  command->add_option("--thickness", a->files.thickness, "of discs [m]; default: of the cell")
      ->check(above(0));
  command->add_option("--density", a->files.density, "of the grains [kg/m3]; default: of the files")
      ->check(above(0));
  CLI::Option* young = command
                           ->add_option("--young", a->young,
                                        "[Pa] of kn = young 2RiRj/(Ri+Rj); default: of the forces")
                           ->check(above(0));
  CLI::Option* kn =
      command->add_option("--kn", a->kn, "[N/m], one for all contacts")->check(above(0));
  CLI::Option* pressure = command
                              ->add_option("--pressure", a->pressure,
                                           "[Pa] that the overlaps stand for, without forces")
                              ->check(above(0));
  kn->excludes(young);
  pressure->excludes(young)->excludes(kn);
  CLI::Option* ratio =
      command->add_option("--ratio", a->ratio, "kt / kn [-]; default: of the forces, else 0.8")
          ->check(at_least(0));
  CLI::Option* friction =
      command->add_option("--friction", a->friction, "tan(phi) [-]; default: 0.5")
          ->check(at_least(0));
  CLI::Option* material = command->add_option(
      "--material", a->material, "material file whose [contact], [boundary], [solver] are meant");
  for (CLI::Option* other : {young, kn, pressure, ratio, friction}) material->excludes(other);
  a->destination.add_options(*command);
  command->add_option("--name", a->name, "NAME of the results; default: of FILE");
  command->callback([a] { run_import(*a); });
}

}  // namespace verification

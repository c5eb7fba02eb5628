#include "material/material_file.hpp"

#include "base/constants.hpp"
#include "base/error.hpp"
#include "io/text_file.hpp"
#include "io/toml_table.hpp"
#include "material/boundary_keys.hpp"
#include "material/contact_keys.hpp"
#include "material/packing_file.hpp"
#include "material/packing_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace grainlaw::core {
namespace {

bool prescribes_stress(const BoundaryOptions& boundary) {
  const auto given = [](const auto& component) { return component.has_value(); };
  const auto uniform = [](const Side& s) { return s.x == SideRule::t || s.y == SideRule::t; };
  return std::ranges::any_of(boundary.stress, given) ||
         std::ranges::any_of(sides_of(boundary), uniform);
}

PublishedOptions read_published(TomlTable table) {
  PublishedOptions published;
  table.optional("damping", number_above_up_to(0, 1), published.damping);
  table.optional("time_step_ratio", number_above_up_to(0, 1), published.time_step_ratio);
  table.optional("energy_tolerance", number_at_least(0), published.energy_tolerance);
  table.optional("max_steps", integer_between(1), published.max_steps);
  table.finish();
  return published;
}

void read_viscosity(TomlTable& table, SolverOptions& solver) {
  Viscosity& viscosity = solver.viscosity;
  for (const char* old : {"viscous_time", "viscous_inertia", "viscous_increment"}) {
    if (table.has(old))
      table.fail(old, "a key of an earlier law",
                 "viscous_number (1e-3, say), and viscous_rate where the host's time counts");
  }
  table.optional("viscous_number", number_at_least(0), viscosity.number);
  for (const char* key : {"viscous_steps", "viscous_rate"}) {
    if (viscosity.number == 0 && table.has(key))
      table.fail(key, "a value", "none but with viscous_number > 0");
  }
  table.optional("viscous_rate", number_at_least(0), viscosity.rate);
  table.optional("viscous_steps", integer_between(1, tuned::most_subincrements), viscosity.steps);
  if (viscosity.number == 0) return;
  if (solver.method != Method::direct)
    table.fail("viscous_number", fmt::format("{:g} with another method", viscosity.number),
               "method = \"direct\"");
  if (solver.loose_tolerance > 0)
    table.fail("loose_tolerance", fmt::format("{:g} with viscous_number", solver.loose_tolerance),
               "0: with drag every increment is balanced");
}

void read_inertia(TomlTable& table, const BoundaryOptions& boundary, SolverOptions& solver) {
  table.optional("inertia", boolean(), solver.inertia);
  if (!solver.inertia) return;
  const auto refuse = [&](const char* found, const char* expected) {
    table.fail("inertia", fmt::format("true with {}", found), expected);
  };
  if (solver.viscosity.number > 0)
    refuse("viscous_number", "one of them: both say how fluctuations take time");
  if (solver.method != Method::direct) refuse("another method", "method = \"direct\"");
  if (solver.loose_tolerance > 0) refuse("loose_tolerance", "loose_tolerance = 0");
  if (boundary.type == BoundaryType::frame_t || prescribes_stress(boundary))
    refuse("a boundary under a stress",
           "a periodic cell, \"frame-p\", \"frame-d\", or sides of D and P");
}

// Reads the solver options; the published servo works with the published relaxation alone.
SolverOptions read_solver(TomlTable table, const BoundaryOptions& boundary) {
  const bool servo = boundary.method == BoundaryMethod::servo;
  SolverOptions solver;
  table.optional("tolerance", number_between(1e-14, 1e-1), solver.tolerance);
  table.optional("loose_tolerance", number_between(0, 1e-1), solver.loose_tolerance);
  if (solver.loose_tolerance > 0 && solver.loose_tolerance < solver.tolerance)
    table.fail("loose_tolerance", fmt::format("{:g}", solver.loose_tolerance),
               fmt::format("0 or at least solver.tolerance, {:g}", solver.tolerance));
  table.optional("start", one_of<Start>({{"committed", Start::committed}, {"trial", Start::trial}}),
                 solver.start);
  if (servo) solver.method = Method::published;
  table.optional("method",
                 one_of<Method>({{"direct", Method::direct},
                                 {"advancing", Method::advancing},
                                 {"published", Method::published},
                                 {"chain", Method::direct}}),
                 solver.method);
  if (servo && solver.method != Method::published)
    table.fail("method", "another method", "\"published\" because boundary.method is \"servo\"");
  table.optional("force_floor", number_at_least(0), solver.force_floor);
  if (solver.force_floor > 0 && prescribes_stress(boundary))
    table.fail("force_floor",
               fmt::format("{:g} with a boundary under a stress", solver.force_floor),
               "0: below a floor nothing carries what \"T\" or boundary.stress asks for");
  table.optional("increment_limit", number_above(0), solver.increment_limit);
  table.optional("contacts_lost",
                 one_of<ContactsLost>(
                     {{"error", ContactsLost::error}, {"stress_free", ContactsLost::stress_free}}),
                 solver.contacts_lost);
  if (solver.contacts_lost == ContactsLost::stress_free && prescribes_stress(boundary))
    table.fail(
        "contacts_lost", "\"stress_free\" with a boundary under a stress",
        "\"error\": without contacts nothing carries what \"T\" or boundary.stress asks for");
  read_viscosity(table, solver);
  read_inertia(table, boundary, solver);
  solver.published = read_published(table.optional_table("published"));
  if (solver.method != Method::published && table.has("published"))
    table.fail("published", "a table", "none but with method = \"published\"");
  table.finish();
  return solver;
}

PackingPaths read_paths(TomlTable& table, const std::filesystem::path& directory) {
  const auto path = text("a path relative to this file");
  const auto below = [&](const std::string& name) { return (directory / name).string(); };
  PackingPaths paths;
  paths.particles = below(table.required("particles", path));
  paths.cell = below(table.required("cell", path));
  if (const auto contacts = table.optional("contacts", path)) paths.contacts = below(*contacts);
  return paths;
}

// Fails unless a thickness in the material file equals that of the cell file.
void check_thickness(const TomlTable& top, double given, double of_cell, const std::string& cell) {
  constexpr double tolerance = 1e-9;  // relative error of digits lost in a file
  if (std::abs(given - of_cell) > tolerance * of_cell)
    top.fail("thickness", fmt::format("{}", given), fmt::format("{} as in {}", of_cell, cell));
}

// Fails for options that spheres do not support.
void check_spheres(const TomlTable& top, const MaterialDescription& description) {
  if (description.boundary.type != BoundaryType::periodic_cell)
    top.fail("boundary", "a frame",
             "type = \"periodic-cell\" with dimension = 3: frames are plane");
}

MaterialDescription read_description(TomlTable& top, const std::filesystem::path& directory) {
  MaterialDescription description;
  const Expectation<long> two_or_three{"2 (discs) or 3 (spheres)", integer_between(2, 3).read};
  const long dimension = top.required("dimension", two_or_three);
  const auto thickness = top.optional("thickness", number_above(0));
  if (dimension == 3 && thickness)
    top.fail("thickness", "a number", "none with dimension = 3: spheres have their own");
  TomlTable packing = top.required_table("packing");
  description.law = read_contact(top.required_table("contact"), dimension);
  description.boundary = read_boundary(top.optional_table("boundary"));
  if (description.boundary.inner_rotation == InnerRotation::fixed && !description.law.rotating())
    top.required_table("boundary")
        .fail("inner_rotation", "\"fixed\" where no particle rotates",
              "none, or a contact with rotation");
  description.solver = read_solver(top.optional_table("solver"), description.boundary);
  top.finish();
  if (dimension == 3) check_spheres(top, description);
  description.packing.dimension = static_cast<int>(dimension);

  packing.require_either("particles", "generator");
  if (packing.has("generator")) {
    description.generator = read_generator(packing, dimension);
    packing.optional("density", number_above(0), description.generator->density);
    packing.finish();
    if (dimension == 3) return description;
    if (!thickness) top.fail("thickness", "nothing", "a number > 0 with a generator");
    description.generator->thickness = *thickness;
    return description;
  }
  const PackingPaths paths = read_paths(packing, directory);
  const auto density = packing.optional("density", number_above(0));
  packing.finish();
  description.packing = read_packing(paths, static_cast<int>(dimension));
  if (density) description.packing.density = *density;
  if (thickness) check_thickness(top, *thickness, description.packing.thickness, paths.cell);
  return description;
}

}  // namespace

MaterialDescription read_material_file(const std::string& path) {
  return parse_material(read_text(path), std::filesystem::path(path).parent_path().string(), path);
}

MaterialDescription parse_material(std::string_view text, const std::string& base_directory,
                                   const std::string& name, KeyLog* log) {
  const toml::table parsed = parse_toml(text, name);
  TomlTable top(parsed, name, "", log);
  return read_description(top, base_directory);
}

}  // namespace grainlaw::core

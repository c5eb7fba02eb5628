#include "app/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

namespace verification {

namespace {

// Drops keys of another contact law, which the new law would refuse, and a second way to state one
// stiffness.
void drop_what_is_refused(toml::table& before, const toml::table& after) {
  if (after.contains("kn")) before.erase("young");
  if (after.contains("young")) before.erase("kn");
  const auto law = after["law"].value_or(std::string_view());
  if (law.empty() || law == before["law"].value_or(std::string_view())) return;
  const auto drop = [&](std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys) before.erase(key);
  };
  if (law == "hertz") drop({"young", "kn", "ratio", "bond"});
  if (law == "compressive")
    drop({"ratio", "friction", "rotation", "rolling", "bond", "shear_modulus", "poisson"});
  if (law == "frictional") drop({"bond", "shear_modulus", "poisson"});
  if (law == "bonded") drop({"shear_modulus", "poisson"});
}

}  // namespace

void merge(toml::table& target, const toml::table& changes) {
  for (const auto& [key, node] : changes) {
    toml::table* below = target[key.str()].as_table();
    if (below != nullptr && node.is_table()) {
      if (key.str() == "contact") drop_what_is_refused(*below, *node.as_table());
      merge(*below, *node.as_table());
    } else {
      target.insert_or_assign(key, node);
    }
  }
}

namespace {

// "scene: material file", without absent parts.
std::string named(const MaterialSource& source) {
  std::string name = source.scene.empty() ? "" : source.scene.string() + ": ";
  name += "material";
  return source.file.empty() ? name : name + " " + source.file.string();
}

// Message of a text parsed at `base`, without "base:line: " in front.
std::string_view without_line(std::string_view message, const std::string& base) {
  if (!message.starts_with(base + ":")) return message;
  const auto end = message.find(": ");
  return end == std::string_view::npos ? message : message.substr(end + 2);
}

}  // namespace

MaterialSource read_material_source(SceneTable& scene) {
  const std::filesystem::path directory = scene.file().parent_path();
  const toml::node* node = scene.node("material");
  MaterialSource source;
  source.scene = scene.file();
  source.base = directory;
  std::optional<std::string> file;
  if (node != nullptr && node->is_string()) {
    file = node->value<std::string>();
  } else if (node != nullptr && node->is_table()) {
    source.changes = *node->as_table();
    file = source.changes["file"].value<std::string>();
    if (file) source.changes.erase("file");
  } else {
    scene.fail("material", node == nullptr ? "nothing" : "another type",
               "the path of a material file, or a table");
  }
  if (!file) return source;
  source.file = directory / *file;
  source.base = source.file.parent_path();
  std::error_code error;
  const auto kind = std::filesystem::status(source.file, error).type();
  if (file->empty() || kind != std::filesystem::file_type::regular)
    scene.fail("material", file->empty() ? "\"\"" : source.file.string(),
               kind == std::filesystem::file_type::none ? "a file that may be read"
                                                        : "a file that is there");
  return source;
}

MaterialSource unfold(const MaterialSource& source) {
  MaterialSource result = source;
  if (source.file.empty() || source.unfolded) return result;
  result.changes = SceneFile(source.file).content;
  merge(result.changes, source.changes);
  result.unfolded = true;
  return result;
}

MaterialText material_text(const MaterialSource& source) {
  toml::table description;
  std::string origin = named(source);
  if (!source.file.empty()) {
    if (!source.unfolded) description = SceneFile(source.file).content;
    if (!source.changes.empty()) origin += ", as changed";
  }
  merge(description, source.changes);
  std::ostringstream text;
  text << description;
  return {text.str(), source.base.empty() ? "." : source.base.string(), origin};
}

std::vector<std::filesystem::path> files_of(const MaterialSource& source) {
  std::vector<std::filesystem::path> files;
  if (!source.file.empty()) files.push_back(source.file);
  const toml::table material = unfold(source).changes;
  for (const char* key : {"particles", "contacts", "cell"})
    if (const auto path = material["packing"][key].value<std::string>())
      files.push_back(source.base / *path);
  return files;
}

int dimension_of(const MaterialSource& source) {
  return unfold(source).changes["dimension"].value_or(0) == 3 ? 3 : 2;
}

bool has_drag(const MaterialSource& source) {
  return unfold(source).changes["solver"]["viscous_number"].value_or(0.0) > 0;
}

bool has_inertia(const MaterialSource& source) {
  return unfold(source).changes["solver"]["inertia"].value_or(false);
}

Material make_material(const MaterialSource& source, int dimension) {
  const bool as_it_is = source.changes.empty() && !source.file.empty();
  const MaterialText text = as_it_is ? MaterialText{} : material_text(source);
  const std::string origin = as_it_is ? named(source) : text.origin;
  try {
    Material material =
        as_it_is ? Material::load(source.file.string()) : Material::parse(text.text, text.base);
    if (const int found = material.dimension(); found != dimension)
      throw InputError(fmt::format(
          "{}: dimension: found {}, expected {}{}", origin, found, dimension,
          found == 3 ? ": this command is of the plane, `point`, `solve` and `pack` take spheres"
                     : ""));
    return material;
  } catch (const grainlaw::StatusError& error) {
    const std::string_view told = as_it_is ? error.what() : without_line(error.what(), text.base);
    if (error.status() > 0) throw ComputationError(fmt::format("{}: {}", origin, told));
    throw InputError(
        fmt::format("{}: {} ({})", origin, told, grainlaw_status_text(error.status())));
  }
}

double read_tolerance(SceneTable& table, const MaterialSource& material, double usual) {
  const toml::table description = unfold(material).changes;
  const auto solver = description["solver"];
  const bool from_trial = solver["start"].value_or(std::string_view()) == "trial";
  const double least = from_trial ? solver["tolerance"].value_or(0.0) : 0;
  const double tolerance = table.number_or("tolerance", std::max(usual, least), positive);
  if (tolerance < least)
    table.fail(
        "tolerance", fmt::format("{:g}", tolerance),
        fmt::format("solver.tolerance of the material, {:g}, or more; or a smaller one there: "
                    "with start = \"trial\" its stress is known no better",
                    least));
  return tolerance;
}

}  // namespace verification

// Source of a scene's material: a file, a table in the scene, or a file with changes.
#pragma once

#include "app/library.hpp"
#include "app/scene.hpp"

#include <filesystem>
#include <vector>

namespace verification {

// A material description; `changes` replace keys of the file. With an empty `file` the changes are
// the whole description.
struct MaterialSource {
  std::filesystem::path scene;  // the scene that names it
  std::filesystem::path file;   // "" : no file
  std::filesystem::path base;   // base of relative paths in the description
  toml::table changes;
  bool unfolded = false;  // changes contain all keys of the file
};

// Copies the keys of the file into the changes, where whole tables can be replaced.
MaterialSource unfold(const MaterialSource& source);

// Merges `changes` into `target`: tables are merged, other values are replaced.
void merge(toml::table& target, const toml::table& changes);

// Sets one key, e.g. {"solver", "tolerance"}, in the changes.
template <class Value>
void change(MaterialSource& source, std::string_view table, std::string_view key, Value value) {
  if (!source.changes.contains(table)) source.changes.insert(table, toml::table{});
  source.changes[table].as_table()->insert_or_assign(key, value);
}

// Reads the scene's key `material`: a path relative to the scene, or a table. The key `file` of a
// table names a material file that its other keys change; relative paths are then those of that
// file.
MaterialSource read_material_source(SceneTable& scene);

// A whole description as text, the base of its relative paths and its name in messages. Its lines
// belong to no file.
struct MaterialText {
  std::string text;
  std::string base;
  std::string origin;
};
MaterialText material_text(const MaterialSource& source);

// The files that a material is made from: the description's and its packing's.
std::vector<std::filesystem::path> files_of(const MaterialSource& source);

// 3 when the description says so, else 2; errors are reported when the material is created.
int dimension_of(const MaterialSource& source);
// Whether its law is one in time.
bool has_drag(const MaterialSource& source);
bool has_inertia(const MaterialSource& source);

// Creates the material. Throws InputError for a wrong description or dimension, ComputationError
// without an equilibrium at F = I.
Material make_material(const MaterialSource& source, int dimension = 2);

// Reads `tolerance` of a table, a bound of stresses or forces. A material that starts from its last
// trial has these to solver.tolerance alone: the default is no smaller, and a smaller value is
// refused.
double read_tolerance(SceneTable& table, const MaterialSource& material, double usual);

}  // namespace verification

// Where a scene's material comes from: a file, a table in the scene, or a file with changes.
#pragma once

#include "app/library.hpp"
#include "app/scene.hpp"

#include <filesystem>
#include <vector>

namespace verification {

// A material description; `changes` are laid over the file key by key. With an empty `file` the
// changes are the whole description.
struct MaterialSource {
  std::filesystem::path scene;  // that names it
  std::filesystem::path file;   // "" : no file
  std::filesystem::path base;   // where relative paths of the description start
  toml::table changes;
  bool unfolded = false;  // the changes have all that the file says
};

// The same with what its file says among the changes, where whole tables of it can be replaced.
MaterialSource unfold(const MaterialSource& source);

// Lays `changes` over `target`; tables are merged, everything else is replaced.
void merge(toml::table& target, const toml::table& changes);

// Sets one key, e.g. {"solver", "tolerance"}, over what the source says.
template <class Value>
void change(MaterialSource& source, std::string_view table, std::string_view key, Value value) {
  if (!source.changes.contains(table)) source.changes.insert(table, toml::table{});
  source.changes[table].as_table()->insert_or_assign(key, value);
}

// The scene's key `material`: a path relative to the scene, or a table. In a table the key `file`
// names a material file that the other keys change; its relative paths are then those of that file.
MaterialSource read_material_source(SceneTable& scene);

// The whole description as text, where its relative paths start, and what messages call it. Its
// lines are in no file.
struct MaterialText {
  std::string text;
  std::string base;
  std::string origin;
};
MaterialText material_text(const MaterialSource& source);

// The files that a material is made from: of the description and of its packing.
std::vector<std::filesystem::path> files_of(const MaterialSource& source);

// 3 when the description says so, else 2: what is wrong is told when the material is made.
int dimension_of(const MaterialSource& source);

// Throws InputError for a wrong description, or one of another dimension, ComputationError when there
// is no equilibrium at F = I.
Material make_material(const MaterialSource& source, int dimension = 2);

// `tolerance` of a table: what stresses or forces are brought to. Where the material starts from its last
// trial they are known to its solver.tolerance alone: the default is no smaller, and less is refused.
double read_tolerance(SceneTable& table, const MaterialSource& material, double usual);

}  // namespace verification

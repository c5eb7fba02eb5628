// Packings of one recipe at several contact stiffnesses, read back with other frictions.
#pragma once

#include "app/library.hpp"

#include <filesystem>
#include <string>

namespace verification::reach {

struct PackingRecipe {
  std::filesystem::path scene;      // the material file with the generator
  std::filesystem::path directory;  // where packings are written
  int count = 400;
  long seed = 1;            // the first to try
  double tolerance = 1e-8;  // of the equilibria [-]
  bool keep = false;        // those that are in the directory are not made anew
};

// Compacts without friction to kn / (p t) = `stiffness` of two discs of mean radius, and writes the
// packing under the name that is returned. Where a seed leads to no packing, which is printed, the
// next one is taken. Compaction seldom ends beyond 1e4: there a packing of 1e4 is unloaded. Throws
// ComputationError, InputError.
std::string make_packing(const PackingRecipe& recipe, double stiffness);

// That packing with the friction tan(phi) in its contacts, whose stiffness is `factor` times what it
// was made with [-].
Material read_packing(const PackingRecipe& recipe, const std::string& name, double stiffness,
                      double friction, double factor);

}  // namespace verification::reach

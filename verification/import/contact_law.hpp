// What the command line and the forces of a packing say of its contacts.
#pragma once

#include "app/output.hpp"
#include "app/scene.hpp"
#include "import/foreign_packing.hpp"

#include <string>
#include <vector>

namespace verification {

struct ImportArguments {
  ForeignFiles files;
  std::string name, material;
  Destination destination;
  double young = 0, kn = 0, pressure = 0, ratio = -1, friction = -1;
};

// [contact] of the material: told, or what the forces in the files say; what was found or assumed goes to
// the notes. Throws InputError where nothing says how stiff contacts are.
toml::table contact_table(const ImportArguments& arguments, const ForeignPacking& packing,
                          std::vector<std::string>& notes);

}  // namespace verification

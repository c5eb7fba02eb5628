#include "material/packing_file.hpp"

#include "io/text_file.hpp"
#include "material/packing_files.hpp"
#include "material/packing_text.hpp"

#include <array>

namespace grainlaw::core {

namespace {

Packing parse(const PackingTexts& texts, int dimension) {
  return dimension == 3 ? read_space_packing(texts) : read_plane_packing(texts);
}

}  // namespace

Packing read_packing(const PackingPaths& paths, int dimension) {
  const auto source = [](const std::string& path) {
    return PackingText{path, path.empty() ? "" : read_text(path)};
  };
  return parse({source(paths.particles), source(paths.contacts), source(paths.cell)}, dimension);
}

void write_packing(const std::string& prefix, const Packing& packing) {
  const PackingTexts texts{{prefix + "_particles.csv", particles_text(packing)},
                           {prefix + "_contacts.csv", contacts_text(packing)},
                           {prefix + "_cell.csv", cell_text(packing)}};
  parse(texts, packing.dimension);  // refuses what could not be read back
  write_together(std::array<TextFile, 3>{{{texts.particles.path, texts.particles.text},
                                          {texts.contacts.path, texts.contacts.text},
                                          {texts.cell.path, texts.cell.text}}});
}

}  // namespace grainlaw::core

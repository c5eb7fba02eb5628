#include "fe/prestress.hpp"

#include "app/packing_source.hpp"
#include "point/driver.hpp"

#include <fmt/format.h>

namespace verification {

std::vector<Segment> read_prestress(SceneTable& scene) {
  if (!scene.has("prestress")) return {};
  SceneTable table = scene.table("prestress");
  const std::vector<Segment> path = read_segments(table);
  table.close();
  return path;
}

MaterialSource prestressed(const MaterialSource& source, const std::vector<Segment>& path,
                           const std::filesystem::path& stem) {
  const Material material = make_material(source);
  PointDriver driver(material, {});
  try {
    for (const Segment& segment : path) driver.run(segment, {});
  } catch (const ComputationError& error) {
    throw ComputationError(fmt::format("{}: prestress: {}", source.scene.string(), error.what()));
  }
  const std::string prefix = stem.string() + "_prestress";
  check(grainlaw_state_write_packing(driver.state(), prefix.c_str()), "writing " + prefix);
  return with_packing(source, prefix);
}

}  // namespace verification

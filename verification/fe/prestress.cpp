#include "fe/prestress.hpp"

#include "app/packing_source.hpp"
#include "app/state_files.hpp"
#include "point/driver.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace verification {

std::vector<Segment> read_prestress(SceneTable& scene, const MaterialSource& material) {
  if (!scene.has("prestress")) return {};
  SceneTable table = scene.table("prestress");
  const std::vector<Segment> path = read_segments(table, carries_tension(material));
  table.close();
  return path;
}

MaterialSource prestressed(const MaterialSource& source, const std::vector<Segment>& path,
                           const std::filesystem::path& stem) {
  const Material material = make_material(source);
  PointDriver driver(material, {});
  const std::string prefix = stem.string() + "_prestress";
  PackingStart start = look_at_start(driver.state(), source);
  for (std::string& text : far_targets(start, path)) start.unusual.push_back(std::move(text));
  try {
    for (const Segment& segment : path) driver.run(segment, {});
  } catch (const StepError& error) {
    const std::string to_try = smaller_steps(start, path.front());
    throw ComputationError(fmt::format("{}: prestress: {}{}", source.scene.string(), error.what(),
                                       why_at_start(start, driver.record().step, to_try)));
  }
  write_packing(driver.state(), prefix);
  return with_packing(source, prefix);
}

}  // namespace verification

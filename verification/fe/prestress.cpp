#include "fe/prestress.hpp"

#include "app/packing_source.hpp"
#include "app/state_files.hpp"
#include "fe/dimension.hpp"
#include "point/driver.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace verification {

std::vector<Segment> read_prestress(SceneTable& scene, const MaterialSource& material) {
  if (!scene.has("prestress")) return {};
  SceneTable table = scene.table("prestress");
  const std::vector<Segment> path =
      read_segments(table, bears_tension(material), dimension_of(material));
  table.close();
  return path;
}

namespace {

// Leads a packing along the path and writes it.
template <int D>
void lead(const MaterialSource& source, const std::vector<Segment>& path,
          const std::string& prefix) {
  const Material material = make_material(source, D);
  PointDriverOf<D> driver(material, {});
  PackingStart start = measure_start(driver.state(), source);
  for (std::string& text : far_targets(start, path)) start.unusual.push_back(std::move(text));
  const Segment* led = nullptr;
  try {
    for (const Segment& segment : path) driver.run(*(led = &segment), {});
  } catch (const StepError& error) {
    throw ComputationError(fmt::format("{}: prestress: {}{}", source.scene.string(), error.what(),
                                       path_advice(start, driver.record().step, error.status, *led,
                                                   components_of<D>(driver.record().cauchy))));
  }
  write_packing(driver.state(), prefix);
}

}  // namespace

MaterialSource prestressed(const MaterialSource& source, const std::vector<Segment>& path,
                           const std::filesystem::path& stem) {
  const std::string prefix = stem.string() + "_prestress";
  in_dimension(dimension_of(source), [&]<int D>() { lead<D>(source, path, prefix); });
  return with_packing(source, prefix);
}

}  // namespace verification

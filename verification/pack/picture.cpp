#include "pack/picture.hpp"

#include "app/packing_map.hpp"
#include "app/snapshot.hpp"
#include "pack/rose.hpp"
#include "pack/written.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace verification {
namespace {

bool draw_discs(const Snapshot& packing, const Rose& rose, const std::filesystem::path& stem,
                const std::string& title) {
  constexpr double widest = 620, tallest = 640, rose_radius = 130, gap = 24;  // pixels
  const PackingMap map(packing);
  MapScale scale;
  scale.length = std::min(widest / map.width(), tallest / map.height());
  const double radius = scale.length * map.mean_radius();  // pixels
  scale.force = map.mean_force() > 0 ? 0.25 * radius / map.mean_force() : 0;
  scale.widest = 1.6 * radius;
  const double wide = scale.length * map.width() + 2 * rose_radius + 3 * gap;
  Svg svg;
  const std::string head = broken(title, wide - 2 * gap);
  svg.text(gap, gap + 4, head);
  const auto breaks = static_cast<double>(std::count(head.begin(), head.end(), '\n'));
  const double top = gap + 16 + line_height * breaks;
  const double high = std::max(scale.length * map.height(), 2 * rose_radius + 70);
  map.draw(svg, gap, top, scale);
  const double x = wide - gap - rose_radius, y = top + 0.5 * high;
  draw_rose(svg, rose, x, y, rose_radius);
  const std::string middle = "text-anchor='middle' fill='#333333'";
  svg.text(x, y - rose_radius - 30, "contact normals per angle,\nover the mean [-]", middle);
  svg.text(x, y + rose_radius + 20,
           fmt::format("anisotropy {:.3f} [-],\nmost at {:.0f}\u00b0 to x", rose.anisotropy,
                       rose.direction * 180 / std::numbers::pi),
           middle);
  const double foot = top + high + 10;
  const double key = draw_key(svg, map.key(scale), gap, foot, wide - 2 * gap);
  return svg.write(stem, wide, foot + key + 8);
}

}  // namespace

bool draw_packing(const grainlaw_state* state, const std::filesystem::path& stem) {
  const Snapshot packing = take_snapshot(state);
  const std::string title = fmt::format(
      "{} {}, volume fraction {:.3f} [-], coordination number {:.2f} [-]", packing.size(),
      packing.spheres() ? "spheres" : "discs", 1 / (1 + measure_scalar(state, GRAINLAW_VOID_RATIO)),
      measure_scalar(state, GRAINLAW_COORDINATION));
  if (packing.spheres()) return draw_snapshots({{"", packing}}, 0, title, stem);
  return draw_discs(packing, contact_rose(read_written(stem.string())), stem, title);
}

}  // namespace verification

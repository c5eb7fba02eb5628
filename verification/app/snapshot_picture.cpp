#include "app/packing_map.hpp"
#include "app/snapshot.hpp"
#include "app/svg.hpp"

#include <algorithm>

namespace verification {
namespace {

double lines_of(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<double>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

bool draw_snapshots(const std::vector<SnapshotPanel>& panels, double force,
                    const std::string& title, const std::filesystem::path& stem) {
  if (panels.empty()) return true;
  constexpr double widest = 860, tallest = 500, gap = 18;  // pixels
  std::vector<PackingMap> maps;
  double total = 0, highest = 0, mean_force = 0;
  for (const SnapshotPanel& panel : panels) {
    maps.emplace_back(panel.snapshot);
    total += maps.back().width();
    highest = std::max(highest, maps.back().height());
    mean_force = std::max(mean_force, maps.back().mean_force());
  }
  const auto count = static_cast<double>(panels.size());
  MapScale scale;
  scale.length = std::min((widest - gap * (count + 1)) / total, tallest / highest);
  const double radius = scale.length * maps.front().mean_radius();  // pixels
  const double unit = force > 0 ? force : (maps.front().spheres() ? 12 : 4) * mean_force;
  scale.force = unit > 0 ? radius / unit : 0;
  scale.widest = 1.6 * radius;

  const double wide = std::max(scale.length * total + gap * (count + 1), 420.0);
  Svg svg;
  const std::string head = broken(title, wide - 2 * gap);
  svg.text(gap, gap + 8, head);
  std::vector<std::string> captions;
  double lines = 0;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    captions.push_back(broken(panels[k].title, scale.length * maps[k].width()));
    lines = std::max(lines, lines_of(captions.back()));
  }
  const double caption = gap + 8 + line_height * lines_of(head);
  const double top = caption + line_height * lines - 4;
  double left = gap;
  // The key tells the mean force of the map where it is largest.
  std::size_t loaded = 0;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    svg.text(left, caption, captions[k]);
    // Standing on one line.
    maps[k].draw(svg, left, top + scale.length * (highest - maps[k].height()), scale);
    left += scale.length * maps[k].width() + gap;
    if (maps[k].mean_force() > maps[loaded].mean_force()) loaded = k;
  }
  const double foot = top + scale.length * highest + 12;
  const double key = draw_key(svg, maps[loaded].key(scale), gap, foot, wide - 2 * gap);
  return svg.write(stem, wide, foot + key + 8);
}

}  // namespace verification

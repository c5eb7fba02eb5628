#include "fe/output/mesh_picture.hpp"

#include "app/gnuplot.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace verification {
namespace {

constexpr int levels = 64;  // levels of colour
constexpr double millimetre = 1e3;

struct Box {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
};

Box box(const MeshPanel& panel) {
  Box all;
  for (const Polygon& element : panel.elements)
    for (const Eigen::Vector2d& point : element) {
      all.low = all.low.cwiseMin(point);
      all.high = all.high.cwiseMax(point);
    }
  return all;
}

std::array<double, 2> colour_range(const MeshPanel& panel) {
  if (panel.range[0] != panel.range[1]) return panel.range;
  std::vector<double> values;
  for (const double value : panel.values)
    if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {0, 1};
  std::sort(values.begin(), values.end());
  double low = values.front(), high = values.back();
  // Ignores a few extreme values that would take most of the scale; they have its end colours.
  const std::size_t few = values.size() / 200;
  const double most = values[values.size() - 1 - few] - values[few];
  if (few > 0 && high - low > 2 * most && most > 0) {
    low = values[few];
    high = values[values.size() - 1 - few];
  }
  const double room = 1e-4 * std::max({std::abs(low), std::abs(high), 1e-12});
  return high - low > room ? std::array{low, high} : std::array{low - room, high + room};
}

// Characters of the longest tick label of a scale with about five ticks.
std::size_t longest_label(const std::array<double, 2>& range) {
  const double tick = std::pow(10, std::floor(std::log10((range[1] - range[0]) / 4)));
  std::size_t longest = 0;
  for (const double end : range)
    for (const double number : {std::floor(end / tick) * tick, std::ceil(end / tick) * tick})
      longest = std::max(longest, fmt::format("{:.6g}", number).size());
  return longest;
}

// Between numbers on an axis of a length [m] that is so many pixels long [mm].
double tick(double length, double pixels) {
  const double least = 64 * millimetre * length / pixels;
  const double ten = std::pow(10, std::floor(std::log10(least)));
  return ten * (least <= 2 * ten ? 2 : least <= 5 * ten ? 5 : 10);
}

void append_closed(std::string& text, const Polygon& polygon) {
  for (std::size_t k = 0; k <= polygon.size(); ++k) {
    const Eigen::Vector2d point = millimetre * polygon[k % polygon.size()];
    fmt::format_to(std::back_inserter(text), "{:.6g} {:.6g}\n", point.x(), point.y());
  }
  text += "\n";
}

// Data blocks $m<panel>_<level> of patches, one block of outlines, and their plot commands. Patches
// without a finite value are grey.
std::string plot(const MeshPanel& panel, std::size_t number, const std::array<double, 2>& range,
                 std::string& data) {
  std::vector<std::string> blocks(levels + 1);
  for (std::size_t p = 0; p < panel.patches.size(); ++p) {
    const double share = (panel.values[p] - range[0]) / (range[1] - range[0]);
    const int level =
        std::isfinite(share) ? std::clamp(static_cast<int>(share * levels), 0, levels - 1) : levels;
    append_closed(blocks[static_cast<std::size_t>(level)], panel.patches[p]);
  }
  std::vector<std::string> items;
  for (int level = 0; level <= levels; ++level) {
    const std::string& block = blocks[static_cast<std::size_t>(level)];
    if (block.empty()) continue;
    data += fmt::format("$m{}_{} << EOD\n{}EOD\n", number, level, block);
    const std::string colour = level == levels
                                   ? std::string("rgb '#bbbbbb'")
                                   : fmt::format("palette frac {:.4f}", (level + 0.5) / levels);
    items.push_back(
        fmt::format("$m{}_{} with filledcurves closed fs solid 1 lc {}", number, level, colour));
  }
  std::string outlines;
  for (const Polygon& element : panel.elements) append_closed(outlines, element);
  data += fmt::format("$e{} << EOD\n{}EOD\n", number, outlines);
  items.push_back(fmt::format("$e{} with lines lc rgb '#555555' lw 0.5", number));
  // Plots nothing, but makes gnuplot show the colour scale.
  items.push_back("'+' using (NaN):(NaN):(NaN) with points palette");
  return fmt::format("plot {}\n", fmt::join(items, ", "));
}

}  // namespace

bool draw_mesh(const std::vector<MeshPanel>& panels, const std::string& title,
               const std::filesystem::path& stem) {
  if (panels.empty()) return true;
  constexpr double gap = 20, heading = 62, foot = 64, numbers = 62;  // pixels
  double scale_margin = 96;
  for (const MeshPanel& panel : panels) {
    const auto range = colour_range(panel);
    scale_margin = std::max(scale_margin, 44 + 12 * static_cast<double>(longest_label(range)));
  }
  constexpr double widest = 900, tallest = 640;
  const auto count = static_cast<double>(panels.size());
  std::vector<Box> boxes;
  double total = 0, highest = 0;
  for (const MeshPanel& panel : panels) {
    boxes.push_back(box(panel));
    const Eigen::Vector2d size = boxes.back().high - boxes.back().low;
    total += size.x();
    highest = std::max(highest, size.y());
  }
  const double scale = std::min((widest - count * (gap + numbers + scale_margin)) / total,
                                tallest / highest);  // pixels per m
  const double wide = std::max(scale * total + count * (gap + numbers + scale_margin), 420.0);
  const double high = scale * highest + heading + foot;

  std::string body =
      "set multiplot\nset border 15 lc rgb '#555555'\nset tics out nomirror scale 0.6 tc rgb "
      "'#333333'\n"
      "unset key\n"
      "set palette defined (0 '#440154', 0.13 '#472c7a', 0.25 '#3b518b', 0.38 '#2c718e', "
      "0.5 '#21908d', 0.63 '#27ad81', 0.75 '#5cc863', 0.88 '#aadc32', 1 '#fde725')\n";
  body += fmt::format("set label 1 {} at screen {:.5f},{:.5f} left noenhanced\n",
                      gnuplot_text(title), gap / wide, 1 - 16 / high);
  double left = gap + numbers;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Box& b = boxes[k];
    const Eigen::Vector2d size = scale * (b.high - b.low);
    const double right = left + size.x();
    const auto range = colour_range(panels[k]);
    std::string data;
    const std::string command = plot(panels[k], k, range, data);
    body += data;
    body += fmt::format(
        "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
        "set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n",
        left / wide, right / wide, foot / high, (foot + size.y()) / high);
    body += fmt::format(
        "set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\nset xtics {:g}\nset ytics {:g}\n",
        millimetre * b.low.x(), millimetre * b.high.x(), millimetre * b.low.y(),
        millimetre * b.high.y(), tick(b.high.x() - b.low.x(), size.x()),
        tick(b.high.y() - b.low.y(), size.y()));
    body += fmt::format("set cbrange [{:.9g}:{:.9g}]\nset cbtics scale 0.5 format '%g'\n", range[0],
                        range[1]);
    body += fmt::format(
        "set colorbox user origin screen {:.5f},{:.5f} size screen {:.5f},{:.5f} "
        "border\n",
        (right + 12) / wide, foot / high, 12 / wide, std::min(size.y(), 260.0) / high);
    body += fmt::format("set label 2 {} at screen {:.5f},{:.5f} left noenhanced\n",
                        gnuplot_text(panels[k].title), left / wide, 1 - 42 / high);
    if (panels[k].axes.empty())
      body += fmt::format(
          "set label 3 'x [mm]' at screen {:.5f},{:.5f} center\n"
          "set label 4 'y [mm]' at screen {:.5f},{:.5f} center rotate by 90\n",
          0.5 * (left + right) / wide, 14 / high, (left - 54) / wide,
          (foot + 0.5 * size.y()) / high);
    else
      body += fmt::format(
          "unset border\nunset tics\nset cbtics\n"
          "set label 3 {} at screen {:.5f},{:.5f} center\n",
          gnuplot_text(panels[k].axes), 0.5 * (left + right) / wide, 14 / high);
    body += command + "unset label 1\n";
    left = right + gap + numbers + scale_margin;
  }
  body += "unset multiplot\n";
  return run_gnuplot(body, stem, static_cast<int>(std::lround(wide)),
                     static_cast<int>(std::lround(high)));
}

}  // namespace verification

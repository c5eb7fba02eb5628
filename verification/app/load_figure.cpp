#include "app/load_figure.hpp"

#include "app/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

// Value of the largest magnitude, with its sign.
double extreme(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end(),
                           [](double a, double b) { return std::abs(a) < std::abs(b); });
}

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

}  // namespace

bool draw_load_figure(const CsvTable& table, const std::vector<std::string>& conditions,
                      const std::string& unit, const std::filesystem::path& stem) {
  constexpr std::array<const char*, 6> colours{colour::orange, colour::blue, colour::green,
                                               colour::purple, colour::sky,  colour::amber};
  if (table.rows() == 0) return false;
  std::vector<Curve> curves;
  bool against = true;
  for (const std::string& name : conditions) {
    const std::vector<double>& displacement = table[name + "_displacement"];
    const double end = extreme(displacement);
    if (end == 0) continue;
    against = against && end < 0;
    curves.push_back(
        {name, displacement, table[name + "_force"], colours[curves.size() % colours.size()]});
  }
  if (curves.empty()) return false;
  const double sign = against ? -1 : 1;
  for (Curve& curve : curves) {
    scale(curve.x, 1e3 * sign);
    scale(curve.y, 1e-3 * sign);
  }
  const char* suffix = against ? ", against the axis" : "";
  Figure figure{"",
                fmt::format("displacement{} [mm]", suffix),
                {{fmt::format("force{} [k{}]", suffix, unit), curves, 1.6}}};
  return draw(figure, stem);
}

}  // namespace verification

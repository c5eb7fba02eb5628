#include "pack/rose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace verification {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

void point(std::string& text, double radius, double angle) {
  fmt::format_to(std::back_inserter(text), "{:.5g} {:.5g}\n", radius * std::cos(angle),
                 radius * std::sin(angle));
}

}  // namespace

Rose contact_rose(const WrittenPacking& packing, int sectors) {
  Rose rose;
  rose.density.assign(static_cast<std::size_t>(sectors), 0);
  Eigen::Matrix2d fabric = Eigen::Matrix2d::Zero();
  double total = 0;
  for (const WrittenContact& contact : packing.contacts) {
    const Eigen::Vector2d normal = packing.branch(contact).normalized();
    fabric += contact.weight * normal * normal.transpose();
    total += contact.weight;
    for (const double sign : {1.0, -1.0}) {
      // Sectors are centred on the axes; the half beyond the last belongs to the first.
      const double turn = std::atan2(sign * normal.y(), sign * normal.x()) / full_turn;
      const long k = std::lround(turn * sectors);
      rose.density[static_cast<std::size_t>((k + sectors) % sectors)] += contact.weight;
    }
  }
  if (!(total > 0)) return rose;
  for (double& density : rose.density) density *= sectors / (2 * total);
  fabric /= total;
  const double half = std::hypot(0.5 * (fabric(0, 0) - fabric(1, 1)), fabric(0, 1));
  rose.anisotropy = half < 0.5 ? (0.5 + half) / (0.5 - half) - 1 : INFINITY;
  rose.direction = 0.5 * std::atan2(2 * fabric(0, 1), fabric(0, 0) - fabric(1, 1));
  return rose;
}

std::string plot_rose(const Rose& rose) {
  constexpr int fineness = 8;  // points of a sector's arc
  const auto sectors = static_cast<int>(rose.density.size());
  const double width = full_turn / sectors;
  std::string wedges;
  for (int k = 0; k < sectors; ++k) {
    const double radius = rose.density[static_cast<std::size_t>(k)];
    wedges += "0 0\n";
    for (int n = 0; n <= fineness; ++n)
      point(wedges, radius, (k - 0.5 + static_cast<double>(n) / fineness) * width);
    wedges += "0 0\n\n";
  }
  std::string curve;
  std::string circle;
  const double d = 0.5 * rose.anisotropy / (2 + rose.anisotropy);
  for (int n = 0; n <= 180; ++n) {
    const double angle = full_turn * n / 180;
    // The density 1 + a cos 2(angle - direction) has fabric eigenvalues 1/2 + a/4 and 1/2 - a/4.
    point(curve, std::isfinite(d) ? 1 + 4 * d * std::cos(2 * (angle - rose.direction)) : 0, angle);
    point(circle, 1, angle);
  }
  const double reach =
      1.1 * std::max(1.2, *std::max_element(rose.density.begin(), rose.density.end()));
  return fmt::format("$wedges << EOD\n{}EOD\n$curve << EOD\n{}EOD\n$circle << EOD\n{}EOD\n", wedges,
                     curve, circle) +
         fmt::format("set xrange [-{0}:{0}]\nset yrange [-{0}:{0}]\n", reach) +
         "set margins 1,1,1,1\nunset border\nunset tics\nunset xlabel\nunset ylabel\nset size "
         "ratio -1\n"
         "set xzeroaxis lt 1 lc rgb '#cccccc'\nset yzeroaxis lt 1 lc rgb '#cccccc'\n"
         "plot $wedges with filledcurves closed fs solid 0.8 border lc rgb '#ffffff' fc rgb "
         "'#56b4e9' notitle, $circle with lines lc rgb '#555555' lw 1 dt (4,4) notitle, $curve "
         "with lines lc rgb '#d55e00' lw 2 notitle\n";
}

}  // namespace verification

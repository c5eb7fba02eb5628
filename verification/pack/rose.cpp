#include "pack/rose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace verification {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

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
      // Sectors are centred on the axes; a half beyond the last belongs to the first.
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

void draw_rose(Svg& svg, const Rose& rose, double x, double y, double radius) {
  constexpr int fineness = 8;  // corners of a sector's arc
  const double densest = *std::max_element(rose.density.begin(), rose.density.end());
  const double unit = radius / std::max(1.2, densest);  // pixels of the density 1
  const auto at = [&](double density, double angle) -> std::array<double, 2> {
    return {x + unit * density * std::cos(angle), y - unit * density * std::sin(angle)};
  };
  const auto sectors = static_cast<int>(rose.density.size());
  svg.path(fmt::format("M{:.4g} {:.4g}h{:.4g}M{:.4g} {:.4g}v{:.4g}", x - radius, y, 2 * radius, x,
                       y - radius, 2 * radius),
           "stroke='#bbbbbb'");
  std::string wedges;
  for (int k = 0; k < sectors; ++k) {
    std::vector<std::array<double, 2>> corners{{x, y}};
    for (int n = 0; n <= fineness; ++n)
      corners.push_back(at(rose.density[static_cast<std::size_t>(k)],
                           (k - 0.5 + static_cast<double>(n) / fineness) * full_turn / sectors));
    wedges += polyline(corners, true);
  }
  svg.path(wedges, "fill='#56b4e9' fill-opacity='0.8' stroke='#ffffff' stroke-width='0.8'");
  svg.begin("fill='none' stroke='#555555' stroke-dasharray='4 3'");
  svg.circle(x, y, unit);
  svg.end();
  if (!std::isfinite(rose.anisotropy)) return;
  // Density 1 + a cos 2(angle - direction) has the fabric 1/2 +- a / 4.
  const double a = 2 * rose.anisotropy / (2 + rose.anisotropy);
  std::vector<std::array<double, 2>> curve;
  for (int n = 0; n < 180; ++n) {
    const double angle = full_turn * n / 180;
    curve.push_back(at(1 + a * std::cos(2 * (angle - rose.direction)), angle));
  }
  svg.path(polyline(curve, true), "fill='none' stroke='#d55e00' stroke-width='2'");
}

}  // namespace verification

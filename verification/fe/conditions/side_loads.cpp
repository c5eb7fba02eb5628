#include "fe/conditions/side_loads.hpp"

#include <array>
#include <cmath>

namespace verification {
namespace {

// Integral of N_a dN_b/dxi over a side with linear (two nodes) or quadratic (ends, then the middle)
// shape functions.
double coupling(std::size_t nodes, std::size_t a, std::size_t b) {
  constexpr std::array<std::array<double, 2>, 2> linear{{{-0.5, 0.5}, {-0.5, 0.5}}};
  constexpr std::array<std::array<double, 3>, 3> quadratic{
      {{-1.0 / 2, -1.0 / 6, 2.0 / 3}, {1.0 / 6, 1.0 / 2, -2.0 / 3}, {-2.0 / 3, 2.0 / 3, 0}}};
  return nodes == 2 ? linear[a][b] : quadratic[a][b];
}

// Adds a pressure; the outward normal times length is the integral of (dy, -dx) along the side.
void add_pressure(const Pressure& pressure, double value, const Mesh& mesh,
                  const Eigen::VectorXd& displacement, Eigen::VectorXd& force,
                  Triplets* stiffness) {
  for (const Side& side : pressure.sides)
    for (std::size_t a = 0; a < side.size(); ++a)
      for (std::size_t b = 0; b < side.size(); ++b) {
        const double weight = value * coupling(side.size(), a, b);
        Eigen::Vector2d position = mesh.nodes[static_cast<std::size_t>(side[b])];
        if (pressure.follows) position += displacement.segment<2>(2 * side[b]);
        force(2 * side[a]) -= weight * position.y();
        force(2 * side[a] + 1) += weight * position.x();
        if (!pressure.follows || stiffness == nullptr) continue;
        stiffness->emplace_back(2 * side[a], 2 * side[b] + 1, weight);
        stiffness->emplace_back(2 * side[a] + 1, 2 * side[b], -weight);
      }
}

// Integral of N_a over the reference length of a side [m], by three Gauss points.
std::array<double, 3> lengths(const Side& side, const Mesh& mesh) {
  constexpr std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const std::array<double, 3> abscissa{-std::sqrt(0.6), 0, std::sqrt(0.6)};
  std::array<double, 3> sum{};
  for (std::size_t q = 0; q < 3; ++q) {
    const double xi = abscissa[q];
    std::array<double, 3> shape{0.5 * (1 - xi), 0.5 * (1 + xi), 0};
    std::array<double, 3> derivative{-0.5, 0.5, 0};
    if (side.size() == 3) {
      shape = {0.5 * xi * (xi - 1), 0.5 * xi * (xi + 1), 1 - xi * xi};
      derivative = {xi - 0.5, xi + 0.5, -2 * xi};
    }
    Eigen::Vector2d tangent = Eigen::Vector2d::Zero();
    for (std::size_t a = 0; a < side.size(); ++a)
      tangent += derivative[a] * mesh.nodes[static_cast<std::size_t>(side[a])];
    for (std::size_t a = 0; a < side.size(); ++a) sum[a] += weight[q] * tangent.norm() * shape[a];
  }
  return sum;
}

}  // namespace

void add_loads(const Loads& loads, double time, const Mesh& mesh,
               const Eigen::VectorXd& displacement, Eigen::VectorXd& force, Triplets* stiffness) {
  for (const Pressure& pressure : loads.pressures)
    add_pressure(pressure, pressure.value.at(time), mesh, displacement, force, stiffness);
  for (const Traction& traction : loads.tractions) {
    const double value = traction.value.at(time);
    for (const Side& side : traction.sides) {
      const auto share = lengths(side, mesh);
      for (std::size_t a = 0; a < side.size(); ++a)
        force(2 * side[a] + traction.component) += value * share[a];
    }
  }
}

}  // namespace verification

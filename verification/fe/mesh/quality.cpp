#include "fe/mesh/quality.hpp"

#include "app/library.hpp"
#include "fe/dimension.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace verification {
namespace {

// Least det dX/dxi at a node over its mean, and least sine of a corner, about 2 degrees.
constexpr double smallest = 0.03;

struct Quality {
  double volume = 0;                                        // signed [m2], [m3]
  double shrink = std::numeric_limits<double>::infinity();  // least det / mean det, over the nodes
  double sine = std::numeric_limits<double>::infinity();    // least, over the corners
};

// Whether an edge joins two corners: in simplices every two, else those apart along one axis.
bool neighbours(const ElementType& type, std::size_t a, std::size_t b) {
  if (a == b) return false;
  return type.simplex() ||
         ((type.local_nodes[a] - type.local_nodes[b]).array().abs() > 0).count() == 1;
}

// Area or volume that the unit vectors along the edges of a corner span.
template <int D>
double corner_sine(const ElementType& type, const std::vector<Position>& nodes, std::size_t a) {
  Eigen::Matrix<double, D, D> edges;
  Eigen::Index found = 0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(type.corners); ++b)
    if (neighbours(type, a, b)) edges.col(found++) = (nodes[b] - nodes[a]).normalized();
  return std::abs(edges.determinant());
}

template <int D>
Quality quality(const ElementType& type, const std::vector<Position>& nodes) {
  Quality result;
  double local_volume = 0;
  const auto determinant = [&](const Position& xi) {
    const Shape shape = type.shape(xi);
    Eigen::Matrix<double, D, D> sum = Eigen::Matrix<double, D, D>::Zero();
    for (std::size_t a = 0; a < nodes.size(); ++a)
      sum += nodes[a] * shape.derivative.row(static_cast<Eigen::Index>(a));
    return sum.determinant();
  };
  for (const LocalPoint& point : type.points) {
    result.volume += point.weight * determinant(point.xi);
    local_volume += point.weight;
  }
  for (std::size_t a = 0; a < nodes.size(); ++a)
    result.shrink =
        std::min(result.shrink, determinant(type.local_nodes[a]) * local_volume / result.volume);
  for (std::size_t a = 0; a < static_cast<std::size_t>(type.corners); ++a)
    result.sine = std::min(result.sine, corner_sine<D>(type, nodes, a));
  return result;
}

}  // namespace

void check_shapes(const Mesh& mesh, const std::string& place) {
  const ElementType& type = element_type(mesh.kind);
  const bool solid = type.dimension == 3;
  const char* const content = solid ? "volume" : "area";
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const auto nodes = mesh.positions(mesh.elements[e]);
    const Quality found =
        in_dimension(type.dimension, [&]<int D>() { return quality<D>(type, nodes); });
    // Written so that NaN fails.
    std::string what;
    if (!(found.volume > 0))
      what = fmt::format("an inverted or flat one ({} {:.3g} {})", content, found.volume,
                         solid ? "m3" : "m2");
    else if (!(found.shrink > 0))
      what = "one that folds over at a node";
    else if (!(found.shrink >= smallest))
      what = fmt::format("one whose {0} per local {0} shrinks to {1:.2g} of its mean at a node",
                         content, found.shrink);
    else if (!(found.sine >= smallest))
      what = fmt::format("one with a corner angle of sine {:.2g}", found.sine);
    if (what.empty()) continue;
    const Position& first = nodes.front();
    throw InputError(fmt::format(
        "{}: element {} ({}, first node {} at {:.6g}): found {}, expected {}, {} shrinking to no "
        "less than {}",
        place, e + 1, type.name, mesh.elements[e].front() + 1, fmt::join(first, ", "), what,
        solid ? "nodes in the order of Gmsh, corners not flat"
              : "nodes anticlockwise, corner angles between 2 and 178 degrees",
        content, smallest));
  }
}

}  // namespace verification

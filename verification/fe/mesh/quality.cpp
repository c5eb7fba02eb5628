#include "fe/mesh/quality.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace verification {
namespace {

// Least det dX/dxi at a node over its mean, and least sine of a corner's angle, about 2 degrees.
constexpr double smallest = 0.03;

struct Quality {
  double area = 0;                                          // signed [m2]
  double shrink = std::numeric_limits<double>::infinity();  // least det / mean det, over the nodes
  double sine = std::numeric_limits<double>::infinity();    // least, over the corners
};

Quality quality(const ElementType& type, const std::vector<Eigen::Vector2d>& nodes) {
  Quality result;
  double local_area = 0;
  const auto jacobian = [&](const Eigen::Vector2d& xi) {
    const Shape shape = type.shape(xi);
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (std::size_t a = 0; a < nodes.size(); ++a)
      sum += nodes[a] * shape.derivative.row(static_cast<Eigen::Index>(a));
    return sum;
  };
  for (const LocalPoint& point : type.points) {
    result.area += point.weight * jacobian(point.xi).determinant();
    local_area += point.weight;
  }
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const double determinant = jacobian(type.local_nodes[a]).determinant();
    result.shrink = std::min(result.shrink, determinant * local_area / result.area);
  }
  const auto corners = static_cast<std::size_t>(type.corners);
  for (std::size_t a = 0; a < corners; ++a) {
    const Eigen::Vector2d next = nodes[(a + 1) % corners] - nodes[a];
    const Eigen::Vector2d last = nodes[(a + corners - 1) % corners] - nodes[a];
    const double cross = next.x() * last.y() - next.y() * last.x();
    result.sine = std::min(result.sine, cross / (next.norm() * last.norm()));
  }
  return result;
}

}  // namespace

void check_shapes(const Mesh& mesh, const std::string& place) {
  const ElementType& type = element_type(mesh.kind);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const Quality found = quality(type, mesh.positions(mesh.elements[e]));
    // Written so that NaN fails.
    std::string what;
    if (!(found.area > 0))
      what = fmt::format("an inverted or flat one (area {:.3g} m2)", found.area);
    else if (!(found.shrink > 0) || !(found.sine > 0))
      what = "one that folds over at a node";
    else if (!(found.shrink >= smallest))
      what = fmt::format("one whose area per local area shrinks to {:.2g} of its mean at a node",
                         found.shrink);
    else if (!(found.sine >= smallest))
      what = fmt::format("one with a corner angle of sine {:.2g}", found.sine);
    if (what.empty()) continue;
    const Eigen::Vector2d first = mesh.nodes[static_cast<std::size_t>(mesh.elements[e].front())];
    throw InputError(fmt::format(
        "{}: element {} ({}, first node {} at {:.6g}, {:.6g}): found {}, expected nodes "
        "anticlockwise, corner angles between 2 and 178 degrees, area shrinking to no less than {}",
        place, e + 1, type.name, mesh.elements[e].front() + 1, first.x(), first.y(), what,
        smallest));
  }
}

}  // namespace verification

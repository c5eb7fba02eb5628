#include "fe/output/mesh_picture.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification {
namespace {

// Ends of the patches in a row of points, in -1..1, in proportion to the weights.
std::vector<double> patch_ends(int per_direction) {
  if (per_direction == 1) return {-1, 1};
  if (per_direction == 2) return {-1, 0, 1};
  return {-1, -4.0 / 9, 4.0 / 9, 1};
}

// Patch of a point in local coordinates, anticlockwise.
Polygon local_patch(const ElementType& type, const LocalPoint& point) {
  if (type.corners == 3) return {{0, 0}, {1, 0}, {0, 1}};
  const auto count = static_cast<int>(std::lround(std::sqrt(type.points.size())));
  const std::vector<double> ends = patch_ends(count);
  const auto interval = [&](double xi) {
    std::size_t k = 0;
    while (xi > ends[k + 1]) ++k;
    return std::array<double, 2>{ends[k], ends[k + 1]};
  };
  const auto [left, right] = interval(point.xi.x());
  const auto [bottom, top] = interval(point.xi.y());
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

// Outline of an element; curved sides have two parts.
Polygon local_outline(const ElementType& type) {
  Polygon outline;
  for (int side = 0; side < type.corners; ++side) {
    outline.push_back(type.local_nodes[static_cast<std::size_t>(side)]);
    if (type.nodes == 2 * type.corners)
      outline.push_back(type.local_nodes[static_cast<std::size_t>(type.corners + side)]);
  }
  return outline;
}

}  // namespace

MeshPanel mesh_panel(const Mesh& mesh, const PointField& points,
                     const Eigen::VectorXd& displacement, const Field& field) {
  if (field.components != 1)
    throw InputError(fmt::format("the field \"{}\" is a tensor and cannot be drawn", field.name));
  const ElementType& type = element_type(mesh.kind);
  MeshPanel panel;
  panel.title = fmt::format("{} [{}]", field.label, field.picture_unit());
  panel.values = values(field, points);
  for (double& value : panel.values) value *= field.picture_factor();
  for (const std::vector<int>& element : mesh.elements) {
    const auto to_mesh = [&](const Polygon& local) {
      Polygon placed;
      for (const Eigen::Vector2d& xi : local) {
        const NodeValues shape = type.shape(xi).value;
        placed.emplace_back(0, 0);
        for (std::size_t a = 0; a < element.size(); ++a)
          placed.back() += shape(static_cast<Eigen::Index>(a)) *
                           (mesh.nodes[static_cast<std::size_t>(element[a])] +
                            displacement.segment<2>(2 * element[a]));
      }
      return placed;
    };
    for (const LocalPoint& point : type.points)
      panel.patches.push_back(to_mesh(local_patch(type, point)));
    panel.elements.push_back(to_mesh(local_outline(type)));
  }
  return panel;
}

}  // namespace verification

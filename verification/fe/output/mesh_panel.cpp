#include "fe/output/mesh_picture.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace verification {
namespace {

// Ends of the patches in a row of points, in -1..1, in proportion to the weights.
std::vector<double> patch_ends(int per_direction) {
  if (per_direction == 1) return {-1, 1};
  if (per_direction == 2) return {-1, 0, 1};
  return {-1, -4.0 / 9, 4.0 / 9, 1};
}

// Part of a triangle with three points around one of them: from its corner to the centroid.
Polygon third_of_triangle(const Position& xi) {
  const Polygon corners{{0, 0}, {1, 0}, {0, 1}};
  std::size_t k = 0;
  for (std::size_t other = 1; other < 3; ++other)
    if ((corners[other] - xi).norm() < (corners[k] - xi).norm()) k = other;
  const Eigen::Vector2d corner = corners[k];
  return {corner,
          0.5 * (corner + corners[(k + 1) % 3]),
          {1.0 / 3, 1.0 / 3},
          0.5 * (corner + corners[(k + 2) % 3])};
}

// Patch of a point in local coordinates, anticlockwise.
Polygon local_patch(const ElementType& type, const LocalPoint& point) {
  if (type.corners == 3)
    return type.points.size() == 1 ? Polygon{{0, 0}, {1, 0}, {0, 1}} : third_of_triangle(point.xi);
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
    outline.emplace_back(type.local_nodes[static_cast<std::size_t>(side)]);
    if (type.nodes == 2 * type.corners)
      outline.emplace_back(type.local_nodes[static_cast<std::size_t>(type.corners + side)]);
  }
  return outline;
}

// Directions on the picture of a solid, and towards the eye.
struct View {
  static constexpr double azimuth = 0.5, elevation = 0.4;  // [rad]
  Eigen::Vector3d right{std::cos(azimuth), std::sin(azimuth), 0};
  Eigen::Vector3d eye{std::sin(azimuth) * std::cos(elevation),
                      -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  Eigen::Vector3d up = eye.cross(right);

  [[nodiscard]] Eigen::Vector2d place(const Position& position) const {
    return position.size() == 2 ? Eigen::Vector2d(position)
                                : Eigen::Vector2d(right.dot(position), up.dot(position));
  }
};

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t a = 0; a < polygon.size(); ++a) {
    const Eigen::Vector2d &here = polygon[a], &next = polygon[(a + 1) % polygon.size()];
    twice += here.x() * next.y() - here.y() * next.x();
  }
  return 0.5 * twice;
}

// Integration point of an element closest to a place in it.
std::size_t nearest_point(const ElementType& type, const Position& xi) {
  std::size_t nearest = 0;
  for (std::size_t p = 1; p < type.points.size(); ++p)
    if ((type.points[p].xi - xi).norm() < (type.points[nearest].xi - xi).norm()) nearest = p;
  return nearest;
}

// Something to draw: a plane element, or a face of a solid.
class Surface {
 public:
  Surface(const ElementType& type, const Mesh& mesh, const Eigen::VectorXd& displacement,
          const std::vector<int>& nodes)
      : type_(type) {
    const View view;
    for (const int node : nodes)
      corners_.push_back(view.place(mesh.position(node) + mesh.moved(node, displacement)));
  }

  [[nodiscard]] Polygon placed(const Polygon& local) const {
    Polygon polygon;
    for (const Eigen::Vector2d& xi : local) {
      const NodeValues shape = type_.shape(xi).value;
      polygon.emplace_back(0, 0);
      for (std::size_t a = 0; a < corners_.size(); ++a)
        polygon.back() += shape(static_cast<Eigen::Index>(a)) * corners_[a];
    }
    return polygon;
  }

 private:
  const ElementType& type_;
  Polygon corners_;
};

// Adds the faces of solids that belong to one element alone and are turned to the eye.
void add_faces(const Mesh& mesh, const Eigen::VectorXd& displacement,
               const std::vector<double>& values, MeshPanel& panel) {
  const ElementType& type = element_type(mesh.kind);
  const ElementType& face = element_type(type.face);
  const auto nodes_of = [&](std::size_t e, const std::vector<int>& side) {
    std::vector<int> nodes;
    for (const int a : side) nodes.push_back(mesh.elements[e][static_cast<std::size_t>(a)]);
    return nodes;
  };
  std::map<std::set<int>, int> uses;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const auto& side : type.sides) {
      const auto nodes = nodes_of(e, side);
      ++uses[{nodes.begin(), nodes.end()}];
    }
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const auto& side : type.sides) {
      const auto nodes = nodes_of(e, side);
      if (uses[{nodes.begin(), nodes.end()}] > 1) continue;
      const Surface surface(face, mesh, displacement, nodes);
      const Polygon outline = surface.placed(local_outline(face));
      if (area(outline) <= 0) continue;
      panel.elements.push_back(outline);
      for (const LocalPoint& point : face.points) {
        Position within = Position::Zero(3);
        const NodeValues shape = face.shape(point.xi).value;
        for (std::size_t a = 0; a < side.size(); ++a)
          within += shape(static_cast<Eigen::Index>(a)) *
                    type.local_nodes[static_cast<std::size_t>(side[a])];
        panel.patches.push_back(surface.placed(local_patch(face, point)));
        panel.values.push_back(values[e * type.points.size() + nearest_point(type, within)]);
      }
    }
  panel.axes = "seen from the front: x to the right, y away, z up";
}

}  // namespace

MeshPanel mesh_panel(const Mesh& mesh, const PointField& points,
                     const Eigen::VectorXd& displacement, const Field& field) {
  if (field.components != 1)
    throw InputError(fmt::format("the field \"{}\" is a tensor and cannot be drawn", field.name));
  const ElementType& type = element_type(mesh.kind);
  MeshPanel panel;
  panel.title = fmt::format("{} [{}]", field.label, field.picture_unit());
  std::vector<double> of_points = values(field, points);
  for (double& value : of_points) value *= field.picture_factor();
  if (type.dimension == 3) {
    add_faces(mesh, displacement, of_points, panel);
    return panel;
  }
  panel.values = std::move(of_points);
  for (const std::vector<int>& element : mesh.elements) {
    const Surface surface(type, mesh, displacement, element);
    for (const LocalPoint& point : type.points)
      panel.patches.push_back(surface.placed(local_patch(type, point)));
    panel.elements.push_back(surface.placed(local_outline(type)));
  }
  return panel;
}

}  // namespace verification

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

// Adds a pressure on lines; the outward normal times length is the integral of (dy, -dx) along them.
void add_line_pressure(const Pressure& pressure, double value, const Mesh& mesh,
                       const Eigen::VectorXd& displacement, Eigen::VectorXd& force,
                       Triplets* stiffness) {
  for (const Side& side : pressure.sides)
    for (std::size_t a = 0; a < side.size(); ++a)
      for (std::size_t b = 0; b < side.size(); ++b) {
        const double weight = value * coupling(side.size(), a, b);
        Eigen::Vector2d position = mesh.position(side[b]);
        if (pressure.follows) position += displacement.segment<2>(2 * side[b]);
        force(2 * side[a]) -= weight * position.y();
        force(2 * side[a] + 1) += weight * position.x();
        if (!pressure.follows || stiffness == nullptr) continue;
        stiffness->emplace_back(2 * side[a], 2 * side[b] + 1, weight);
        stiffness->emplace_back(2 * side[a] + 1, 2 * side[b], -weight);
      }
}

// Shape functions of a face and its two tangents at a point.
struct FacePoint {
  FacePoint(const ElementType& face, const LocalPoint& point,
            const std::vector<Position>& positions)
      : shape(face.shape(point.xi)), weight(point.weight) {
    for (std::size_t a = 0; a < positions.size(); ++a)
      tangents += positions[a] * shape.derivative.row(static_cast<Eigen::Index>(a));
  }
  [[nodiscard]] Eigen::Vector3d normal() const { return tangents.col(0).cross(tangents.col(1)); }

  Shape shape;
  double weight;
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();  // [m]
};

// Matrix [v]x with [v]x w = v x w.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d result;
  result << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return result;
}

// Adds a pressure on faces of solids; tangent x tangent is the outward normal times area.
void add_face_pressure(const Pressure& pressure, double value, const Mesh& mesh,
                       const Eigen::VectorXd& displacement, Eigen::VectorXd& force,
                       Triplets* stiffness) {
  const ElementType& face = element_type(element_type(mesh.kind).face);
  for (const Side& side : pressure.sides) {
    std::vector<Position> positions = mesh.positions(side);
    for (std::size_t a = 0; a < side.size() && pressure.follows; ++a)
      positions[a] += mesh.moved(side[a], displacement);
    for (const LocalPoint& local : face.points) {
      const FacePoint point(face, local, positions);
      const Eigen::Matrix3d g = cross_matrix(point.tangents.col(0)),
                            h = cross_matrix(point.tangents.col(1));
      for (int a = 0; a < face.nodes; ++a) {
        const int row = 3 * side[static_cast<std::size_t>(a)];
        const double share = value * point.weight * point.shape.value(a);
        force.segment<3>(row) -= share * point.normal();
        if (!pressure.follows || stiffness == nullptr) continue;
        for (int b = 0; b < face.nodes; ++b) {
          const Eigen::Matrix3d block =
              share * (point.shape.derivative(b, 1) * g - point.shape.derivative(b, 0) * h);
          for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
              stiffness->emplace_back(row + i, 3 * side[static_cast<std::size_t>(b)] + k,
                                      block(i, k));
        }
      }
    }
  }
}

// Integral of N_a over the reference area of a face [m2].
std::vector<double> areas(const Side& side, const Mesh& mesh) {
  const ElementType& face = element_type(element_type(mesh.kind).face);
  std::vector<double> sum(side.size());
  for (const LocalPoint& local : face.points) {
    const FacePoint point(face, local, mesh.positions(side));
    for (std::size_t a = 0; a < side.size(); ++a)
      sum[a] +=
          point.weight * point.normal().norm() * point.shape.value(static_cast<Eigen::Index>(a));
  }
  return sum;
}

// Integral of N_a over the reference length of a line [m], by three Gauss points.
std::vector<double> lengths(const Side& side, const Mesh& mesh) {
  constexpr std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const std::array<double, 3> abscissa{-std::sqrt(0.6), 0, std::sqrt(0.6)};
  std::vector<double> sum(side.size());
  for (std::size_t q = 0; q < 3; ++q) {
    const double xi = abscissa[q];
    std::array<double, 3> shape{0.5 * (1 - xi), 0.5 * (1 + xi), 0};
    std::array<double, 3> derivative{-0.5, 0.5, 0};
    if (side.size() == 3) {
      shape = {0.5 * xi * (xi - 1), 0.5 * xi * (xi + 1), 1 - xi * xi};
      derivative = {xi - 0.5, xi + 0.5, -2 * xi};
    }
    Eigen::Vector2d tangent = Eigen::Vector2d::Zero();
    for (std::size_t a = 0; a < side.size(); ++a) tangent += derivative[a] * mesh.position(side[a]);
    for (std::size_t a = 0; a < side.size(); ++a) sum[a] += weight[q] * tangent.norm() * shape[a];
  }
  return sum;
}

}  // namespace

void add_loads(const Loads& loads, double time, const Mesh& mesh,
               const Eigen::VectorXd& displacement, Eigen::VectorXd& force, Triplets* stiffness) {
  const bool solid = mesh.dimension() == 3;
  for (const Pressure& pressure : loads.pressures)
    (solid ? add_face_pressure : add_line_pressure)(pressure, pressure.value.at(time), mesh,
                                                    displacement, force, stiffness);
  for (const Traction& traction : loads.tractions) {
    const double value = traction.value.at(time);
    for (const Side& side : traction.sides) {
      const std::vector<double> share = solid ? areas(side, mesh) : lengths(side, mesh);
      for (std::size_t a = 0; a < side.size(); ++a)
        force(mesh.dof(side[a], traction.component)) += value * share[a];
    }
  }
}

}  // namespace verification

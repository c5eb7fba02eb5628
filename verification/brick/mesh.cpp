#include "brick/mesh.hpp"

#include <cmath>

namespace verification {
namespace {

const std::array<double, 2> gauss{-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)};

double shape(int end, double x) { return 0.5 * (end == 0 ? 1 - x : 1 + x); }
double slope(int end) { return end == 0 ? -0.5 : 0.5; }

// Matrix [v]x with [v]x w = v x w.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d result;
  result << 0, -v(2), v(1), v(2), 0, -v(0), -v(1), v(0), 0;
  return result;
}

}  // namespace

BrickMesh make_box(const std::array<double, 3>& size, const std::array<int, 3>& divisions) {
  BrickMesh mesh;
  const auto [nx, ny, nz] = divisions;
  const auto node = [&, nx = nx, ny = ny](int i, int j, int k) {
    return i + (nx + 1) * (j + (ny + 1) * k);
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const int number = node(i, j, k);
        mesh.nodes.emplace_back(size[0] * i / nx, size[1] * j / ny, size[2] * k / nz);
        if (i == 0) mesh.node_sets["left"].push_back(number);
        if (i == nx) mesh.node_sets["right"].push_back(number);
        if (j == 0) mesh.node_sets["front"].push_back(number);
        if (j == ny) mesh.node_sets["back"].push_back(number);
        if (k == 0) mesh.node_sets["bottom"].push_back(number);
        if (k == nz) mesh.node_sets["top"].push_back(number);
      }
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        std::array<int, 8> e{};
        for (int a = 0; a < 8; ++a)
          e[static_cast<std::size_t>(a)] = node(i + a % 2, j + a / 2 % 2, k + a / 4);
        mesh.elements.push_back(e);
        // Face nodes start along the axis whose cross product with the second points outwards.
        if (i == 0) mesh.faces["left"].push_back({e[0], e[4], e[2], e[6]});
        if (i == nx - 1) mesh.faces["right"].push_back({e[1], e[3], e[5], e[7]});
        if (j == 0) mesh.faces["front"].push_back({e[0], e[1], e[4], e[5]});
        if (j == ny - 1) mesh.faces["back"].push_back({e[2], e[6], e[3], e[7]});
        if (k == 0) mesh.faces["bottom"].push_back({e[0], e[2], e[1], e[3]});
        if (k == nz - 1) mesh.faces["top"].push_back({e[4], e[5], e[6], e[7]});
      }
  return mesh;
}

std::array<BrickPoint, 8> brick_points(const BrickMesh& mesh, const std::array<int, 8>& element) {
  std::array<BrickPoint, 8> points;
  for (std::size_t q = 0; q < 8; ++q) {
    const std::array<double, 3> at{gauss[q % 2], gauss[q / 2 % 2], gauss[q / 4]};
    Eigen::Matrix<double, 8, 3> local;
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  // dX_J / dxi_K
    for (int a = 0; a < 8; ++a) {
      const std::array<int, 3> end{a % 2, a / 2 % 2, a / 4};
      for (std::size_t k = 0; k < 3; ++k) {
        double product = 1;
        for (std::size_t m = 0; m < 3; ++m)
          product *= m == k ? slope(end[m]) : shape(end[m], at[m]);
        local(a, static_cast<Eigen::Index>(k)) = product;
      }
      const int node = element[static_cast<std::size_t>(a)];
      jacobian += mesh.nodes[static_cast<std::size_t>(node)] * local.row(a);
    }
    points[q] = {jacobian.determinant(), local * jacobian.inverse()};
  }
  return points;
}

FacePressure face_pressure(const std::array<Eigen::Vector3d, 4>& positions) {
  FacePressure result;
  for (const double xi : gauss)
    for (const double eta : gauss) {
      Eigen::Vector4d value, along, across;
      for (int a = 0; a < 4; ++a) {
        value(a) = shape(a % 2, xi) * shape(a / 2, eta);
        along(a) = slope(a % 2) * shape(a / 2, eta);
        across(a) = shape(a % 2, xi) * slope(a / 2);
      }
      Eigen::Vector3d g = Eigen::Vector3d::Zero(), h = Eigen::Vector3d::Zero();
      for (int a = 0; a < 4; ++a) {
        g += along(a) * positions[static_cast<std::size_t>(a)];
        h += across(a) * positions[static_cast<std::size_t>(a)];
      }
      for (int a = 0; a < 4; ++a) {
        result.force.segment<3>(3 * a) -= value(a) * g.cross(h);
        for (int b = 0; b < 4; ++b)
          result.derivative.block<3, 3>(3 * a, 3 * b) -=
              value(a) * (across(b) * cross_matrix(g) - along(b) * cross_matrix(h));
      }
    }
  return result;
}

}  // namespace verification

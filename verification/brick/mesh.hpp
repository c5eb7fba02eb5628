// Boxes of eight-node bricks (hex8): trilinear, 2 x 2 x 2 integration points.
#pragma once

#include <Eigen/Dense>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace verification {

struct BrickMesh {
  std::vector<Eigen::Vector3d> nodes;        // [m]
  std::vector<std::array<int, 8>> elements;  // node a + 2 b + 4 c at end a, b, c of x, y, z
  // left, right (x), front, back (y), bottom, top (z).
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<std::array<int, 4>>>
      faces;  // nodes 00, 10, 01, 11, seen from outside
};

// A box from (0, 0, 0) to `size` [m], with so many elements along each axis.
BrickMesh make_box(const std::array<double, 3>& size, const std::array<int, 3>& divisions);

// An integration point: volume [m3], and dN_a/dX_J of the nodes of its element [1/m].
struct BrickPoint {
  double volume = 0;
  Eigen::Matrix<double, 8, 3> gradient;
};
std::array<BrickPoint, 8> brick_points(const BrickMesh& mesh, const std::array<int, 8>& element);

// Unit pressure on a deformed bilinear face: nodal forces [N / Pa], and their derivative by the
// node positions, by nodes [m].
struct FacePressure {
  Eigen::Matrix<double, 12, 1> force = Eigen::Matrix<double, 12, 1>::Zero();
  Eigen::Matrix<double, 12, 12> derivative = Eigen::Matrix<double, 12, 12>::Zero();
};
FacePressure face_pressure(const std::array<Eigen::Vector3d, 4>& positions);

}  // namespace verification

// Meshes of four-node quadrilaterals.
#pragma once

#include <Eigen/Dense>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace verification {

struct Mesh {
  std::vector<Eigen::Vector2d> nodes;        // reference positions [m]
  std::vector<std::array<int, 4>> elements;  // anticlockwise
  std::map<std::string, std::vector<int>> node_sets;
  // Element sides from the first node to the second, the element on the left.
  std::map<std::string, std::vector<std::array<int, 2>>> side_sets;
};

// size [m] and number of elements along x and y; sets "left", "right", "bottom", "top".
Mesh rectangle_mesh(const std::array<double, 2>& size, const std::array<int, 2>& divisions);

// A quadrature point of an element.
struct QuadPoint {
  Eigen::Matrix<double, 4, 2> gradient;  // dN_a/dX_J [1/m]
  double weight;                         // reference area it stands for [m2]
};

// The 2 x 2 Gauss points of a bilinear element with these corners.
std::array<QuadPoint, 4> quad_points(const std::array<Eigen::Vector2d, 4>& corners);

}  // namespace verification

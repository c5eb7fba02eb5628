// Meshes of four-node quadrilaterals or of three-node triangles.
#pragma once

#include <Eigen/Dense>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace verification {

struct Mesh {
  std::vector<Eigen::Vector2d> nodes;      // reference positions [m]
  std::vector<std::vector<int>> elements;  // corners, anticlockwise
  std::map<std::string, std::vector<int>> node_sets;
  // Element sides from the first node to the second, the element on the left.
  std::map<std::string, std::vector<std::array<int, 2>>> side_sets;
};

enum class ElementKind { q4, t3 };

// size [m] and number of cells along x and y; sets "left", "right", "bottom", "top". A cell is one
// quadrilateral, or two triangles on either side of its diagonal from bottom left to top right: the
// one on the right first, as FreeFEM's `square` has them.
Mesh rectangle_mesh(const std::array<double, 2>& size, const std::array<int, 2>& divisions,
                    ElementKind kind);

// A quadrature point of an element.
struct QuadPoint {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::ColMajor, 4, 2> gradient;  // dN_a/dX_J [1/m]
  double weight;  // reference area it stands for [m2]
};

// The 2 x 2 Gauss points of a bilinear element with four corners, the one point of a linear element
// with three.
std::vector<QuadPoint> quad_points(const std::vector<Eigen::Vector2d>& corners);

}  // namespace verification

// Stabilisation of quadrilaterals with one point (Flanagan & Belytschko 1981, stiffness form).
#pragma once

#include "fe/conditions/side_loads.hpp"
#include "fe/mesh/mesh.hpp"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace verification {

// Springs against the hourglass modes u_a = h_a c, h = (1, -1, 1, -1), which one point does not
// resist. With q = sum_a gamma_a u_a, gamma orthogonal to every affine field, the internal force on
// node a is stiffness q gamma_a. In the reference configuration this is linear, zero for affine
// fields, and objective.
class Hourglass {
 public:
  Hourglass() = default;
  // stiffness = coefficient * modulus * area * |dN/dX|^2, modulus [Pa] of uniaxial strain. No
  // springs in a mesh of other elements.
  Hourglass(const Mesh& mesh, double coefficient, double modulus);

  void add_force(const Eigen::VectorXd& displacement, Eigen::VectorXd& force) const;  // [N/m]
  void add_stiffness(Triplets& triplets) const;

 private:
  struct Spring {
    std::vector<int> nodes;
    std::array<double, 4> gamma;
    double stiffness;  // [N/m2]
    [[nodiscard]] Eigen::Vector2d stretch(const Eigen::VectorXd& displacement) const;
  };
  std::vector<Spring> springs_;
};

}  // namespace verification

// A length for bodies whose material has none: what resists a strain that differs from its average.
#pragma once

#include "fe/conditions/side_loads.hpp"
#include "fe/mesh/mesh.hpp"

#include <Eigen/Dense>

namespace verification {

struct AverageOptions {
  double length = 0;     // l; 0: none [m]
  double modulus = 0.1;  // H, of the modulus at the start [-]
};

// The average A of the displacement gradient g is its implicit gradient, A - l^2 div grad A = g with
// natural conditions on the sides, and the energy H/2 (g : (g - A)) per area: nothing for a strain that is the
// same everywhere, H l^2/2 |grad g|^2 (second gradient) for one that varies over many l, H/2 |g|^2 for one that
// varies within l. The packing has F itself; to its P comes H (g - A), whose mean over the body is 0.
//
// An average in place of F would not do: of a softening material, whose P falls with a strain of every wave
// length alike, it only divides the tangent by 1 + l^2 k^2 and leaves its sign.
//
// A follows linearly from the displacement, so that all this is one constant, symmetric and positive stiffness,
// the same for both components: exact in Newton, and unchanged by a rotation of the body. It is full: for
// meshes of some thousand nodes.
class StrainAverage {
 public:
  StrainAverage() = default;
  StrainAverage(const Mesh& mesh, double length, double modulus);  // m, Pa

  void add_force(const Eigen::VectorXd& displacement, Eigen::VectorXd& force) const;  // [N/m]
  void add_stiffness(Triplets& triplets) const;

 private:
  Eigen::MatrixXd stiffness_;  // by nodes [Pa]; none without a length
};

}  // namespace verification

// An internal length of bodies: a resistance to strains that differ from their average.
#pragma once

#include "fe/conditions/side_loads.hpp"
#include "fe/mesh/mesh.hpp"

#include <Eigen/Dense>

namespace verification {

struct AverageOptions {
  double length = 0;     // l; 0: none [m]
  double modulus = 0.1;  // H, of the modulus at the start [-]
};

// Energy H/2 (g : (g - A)) per area, with the displacement gradient g and its implicit average A -
// l^2 div grad A = g, natural at the sides; in space per volume. A uniform strain has none. A strain that varies over
// many l has H l^2/2 |grad g|^2 (second gradient), one that varies within l has H/2 |g|^2. The
// packing has F itself; its P gains H (g - A), whose mean over the body is 0.
//
// F from an average would not help. P of a softening material falls with strains of every wave
// length; an average divides the tangent by 1 + l^2 k^2 and leaves its sign.
//
// A is linear in the displacement. The stiffness is thus constant, symmetric, positive, one for
// all components: exact in Newton and invariant under rotations. It is a full matrix, for meshes
// of some thousand nodes.
class StrainAverage {
 public:
  StrainAverage() = default;
  StrainAverage(const Mesh& mesh, double length, double modulus);  // m, Pa

  void add_force(const Eigen::VectorXd& displacement, Eigen::VectorXd& force) const;  // [N/m]
  void add_stiffness(Triplets& triplets) const;

 private:
  int dimension_ = 2;
  Eigen::MatrixXd stiffness_;  // per pair of nodes [Pa], of solids [N/m]; empty without a length
};

}  // namespace verification

// Quadrilaterals without locking: F-bar (de Souza Neto, Peric, Dutko & Owen 1996, Int. J. Solids
// Struct. 33, 3277), in the plane and in the reference configuration.
#pragma once

#include "app/library.hpp"
#include "fe/mesh/element.hpp"

namespace verification {

// Deformation of the packing, F_bar = sqrt(r) F with r = det F_centre / det F (eq. 4). The element
// has the Cauchy stress of the packing on the mesh (eq. 9): P = J sigma(F_bar) F^-T = P(F_bar) /
// sqrt(r). The points of an element then share one area ratio. Four ratios would lock where
// dilatancy couples area with shear: what one point gains the next one loses. The stiffness is not
// symmetric.
class MeanVolume {
 public:
  MeanVolume() = default;  // r = 1: every point keeps its area ratio
  // Built from displacement gradients at point and centre, and the rows dN_a/dX there.
  MeanVolume(const Tensor& gradient, const Tensor& gradient_at_centre, const NodeRows& slopes,
             const NodeRows& slopes_at_centre);

  [[nodiscard]] Tensor packing_deformation(const Tensor& deformation) const {
    return root_ * deformation;
  }
  [[nodiscard]] Tensor on_mesh(const Tensor& stress_of_packing) const {
    return stress_of_packing / root_;
  }
  // Change of the mesh's stress with r, a tensor times a vector per node: dP = A(F_bar) : dF +
  // follow (sum_b by_node_b . du_b).
  [[nodiscard]] static Tensor follow(const Tangent& tangent_of_packing, const Tensor& deformation,
                                     const Tensor& stress_on_mesh);
  [[nodiscard]] const NodeRows& by_node() const { return by_node_; }  // d ln r / du_b [1/m]

 private:
  double root_ = 1;   // square root of r
  NodeRows by_node_;  // empty where r is 1
};

}  // namespace verification

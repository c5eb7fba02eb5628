// Quadrilaterals that do not lock: F-bar (de Souza Neto, Peric, Dutko & Owen 1996, Int. J. Solids
// Struct. 33, 3277), in the plane and in the reference configuration.
#pragma once

#include "app/library.hpp"
#include "fe/mesh/element.hpp"

namespace verification {

// The packing of a point gets F with the area ratio of the element's centre,
//   F_bar = sqrt(r) F, r = det F_centre / det F (eq. 4),
// and the element has the Cauchy stress of the packing on the mesh's own configuration (eq. 9):
//   P = J sigma(F_bar) F^-T = P(F_bar) / sqrt(r).
// The points of an element then share one area ratio, while four of their own lock where dilatancy
// couples area with shear: what one gains the next one loses. The stiffness is not symmetric.
class MeanVolume {
 public:
  MeanVolume() = default;  // of an element whose points have the area ratio they have: r = 1
  // gradient: of the displacement in the point and in the centre; the rows dN_a/dX there.
  MeanVolume(const Tensor& gradient, const Tensor& gradient_at_centre, const NodeRows& slopes,
             const NodeRows& slopes_at_centre);

  [[nodiscard]] Tensor seen_by_packing(const Tensor& deformation) const {
    return root_ * deformation;
  }
  [[nodiscard]] Tensor on_mesh(const Tensor& stress_of_packing) const {
    return stress_of_packing / root_;
  }
  // What the stress on the mesh changes by the change of r: a tensor times a vector for every node,
  // dP = A(F_bar) : dF + follow (sum_b by_node_b . du_b).
  [[nodiscard]] static Tensor follow(const Tangent& tangent_of_packing, const Tensor& deformation,
                                     const Tensor& stress_on_mesh);
  [[nodiscard]] const NodeRows& by_node() const { return by_node_; }  // d ln r / du_b [1/m]

 private:
  double root_ = 1;   // of r
  NodeRows by_node_;  // no rows where r is 1
};

}  // namespace verification

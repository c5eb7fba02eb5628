// Quadrilaterals and hexahedra without locking: F-bar (de Souza Neto, Peric, Dutko & Owen 1996, Int.
// J. Solids Struct. 33, 3277), in the reference configuration.
#pragma once

#include "app/library.hpp"
#include "fe/mesh/element.hpp"

namespace verification {

// Deformation of the packing, F_bar = s F with s^D = r = det F_centre / det F (eq. 4), D the
// dimension. The element has the Cauchy stress of the packing on the mesh (eq. 9): P = J
// sigma(F_bar) F^-T = P(F_bar) / s^(D-1). The points of an element then share one volume ratio.
// Several would lock where dilatancy couples volume with shear: what one point gains the next one
// loses. The stiffness is not symmetric.
class MeanVolume {
 public:
  MeanVolume() = default;  // r = 1: every point keeps its volume ratio
  // Built from displacement gradients at point and centre, and the rows dN_a/dX there.
  template <int D>
  MeanVolume(const TensorOf<D>& gradient, const TensorOf<D>& gradient_at_centre,
             const NodeRows& slopes, const NodeRows& slopes_at_centre);

  template <int D>
  [[nodiscard]] TensorOf<D> packing_deformation(const TensorOf<D>& deformation) const {
    return root_ * deformation;
  }
  template <int D>
  [[nodiscard]] TensorOf<D> on_mesh(const TensorOf<D>& stress_of_packing) const {
    return stress_of_packing / (D == 2 ? root_ : root_ * root_);
  }
  // dP/dF on the mesh at constant r.
  template <int D>
  [[nodiscard]] TangentOf<D> tangent_on_mesh(const TangentOf<D>& tangent_of_packing) const {
    return tangent_of_packing / (D == 2 ? 1 : root_);
  }
  // Change of the mesh's stress with r, a tensor times a vector per node: dP = A : dF + follow
  // (sum_b by_node_b . du_b), with A and P on the mesh.
  template <int D>
  [[nodiscard]] static TensorOf<D> follow(const TangentOf<D>& tangent,
                                          const TensorOf<D>& deformation,
                                          const TensorOf<D>& stress) {
    const ComponentsOf<D> along = tangent * components_of<D>(deformation);
    return (tensor_of<D>(along) - (D - 1) * stress) / D;
  }
  [[nodiscard]] const NodeRows& by_node() const { return by_node_; }  // d ln r / du_b [1/m]

 private:
  double root_ = 1;   // s
  NodeRows by_node_;  // empty where r is 1
};

}  // namespace verification

#include "fe/mean_volume.hpp"

#include "app/record.hpp"

#include <cmath>

namespace verification {

MeanVolume::MeanVolume(const Tensor& gradient, const Tensor& gradient_at_centre,
                       const NodeRows& slopes, const NodeRows& slopes_at_centre) {
  const Tensor here = Tensor::Identity() + gradient;
  const Tensor centre = Tensor::Identity() + gradient_at_centre;
  const double ratio = centre.determinant() / here.determinant();
  if (!(ratio > 0) || !std::isfinite(ratio)) return;  // inverted: the packing will refuse it
  root_ = std::sqrt(ratio);
  by_node_ = slopes_at_centre * centre.inverse() - slopes * here.inverse();
}

Tensor MeanVolume::follow(const Tangent& tangent_of_packing, const Tensor& deformation,
                          const Tensor& stress_on_mesh) {
  const Vector4 along = tangent_of_packing * to_vector(deformation);
  return 0.5 * (to_tensor(along) - stress_on_mesh);
}

}  // namespace verification

#include "fe/mean_volume.hpp"

#include <cmath>

namespace verification {

template <int D>
MeanVolume::MeanVolume(const TensorOf<D>& gradient, const TensorOf<D>& gradient_at_centre,
                       const NodeRows& slopes, const NodeRows& slopes_at_centre) {
  const TensorOf<D> here = TensorOf<D>::Identity() + gradient;
  const TensorOf<D> centre = TensorOf<D>::Identity() + gradient_at_centre;
  const double ratio = centre.determinant() / here.determinant();
  if (!(ratio > 0) || !std::isfinite(ratio)) return;  // inverted: the packing will refuse it
  root_ = D == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
  const TensorOf<D> by_centre = centre.inverse(), by_here = here.inverse();
  by_node_ = slopes_at_centre * by_centre - slopes * by_here;
}

template MeanVolume::MeanVolume(const TensorOf<2>&, const TensorOf<2>&, const NodeRows&,
                                const NodeRows&);
template MeanVolume::MeanVolume(const TensorOf<3>&, const TensorOf<3>&, const NodeRows&,
                                const NodeRows&);

}  // namespace verification

// Deformation, stress and measures of a state as its host counts them: from its reference.
#include "homogenise/measures.hpp"
#include "state/state.hpp"

#include <algorithm>
#include <utility>

namespace grainlaw::core {

template <int D>
Tensor<D> State<D>::effective(const double* F) const {
  Tensor<D> f = tensor_of<D>(F);
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (material_->space.found[k]) f[k] = committed_.deformation[k];
  }
  return f;
}

template <int D>
void State<D>::restore(SavedStateOf<D> saved) {
  committed_ = std::move(saved.committed);
  reference_ = saved.reference;
  time_step_ = saved.time_step;
  has_trial_ = false;
}

template <int D>
void State<D>::restore(Configuration<D> committed) {
  restore(SavedStateOf<D>{std::move(committed), untold, {}});
}

template <int D>
void State<D>::set_reference_here() {
  reference_.emplace(committed_.deformation);
  committed_.dissipated = committed_.broken_bonds = 0;
  committed_.velocity.clear();
  committed_.strain_rate = {};
  const std::size_t positions = D * material_->packing.size();
  if (committed_.coordinates.size() > positions) {
    committed_.coordinates.resize(positions);
    append_zero_rotations<D>(material_->packing.size(), committed_.coordinates);
  }
  has_trial_ = false;
}

template <int D>
Tensor<D> State<D>::deformation_of_host(const Configuration<D>& there) const {
  return reference_ ? reference_->to_host(there.deformation) : there.deformation;
}

template <int D>
Tensor<D> State<D>::stress_of_host(const Configuration<D>& there) const {
  return reference_ ? reference_->stress_of_host(there.stress) : there.stress;
}

template <int D>
double State<D>::unforeseen(std::span<const double> tangent) const {
  const Tensor<D> F = deformation_of_host(current()), F_from = deformation_of_host(committed_);
  const Tensor<D> P = stress_of_host(current()), P_from = stress_of_host(committed_);
  double squares = 0;
  for (std::size_t i = 0; i < squared<D>; ++i) {
    double left = P[i] - P_from[i];
    for (std::size_t k = 0; k < squared<D>; ++k)
      left -= tangent[squared<D> * i + k] * (F[k] - F_from[k]);
    squares += left * left;
  }
  return squares;
}

template <int D>
void State<D>::measure(grainlaw_measure what, double* value) const {
  grainlaw::core::measure(material_->problem(), current(), what, value);
  if (!reference_) return;
  if (what == GRAINLAW_REFERENCE_VOLUME) *value *= reference_->volume();
  if (what == GRAINLAW_DEFORMATION_GRADIENT)
    std::ranges::copy(deformation_of_host(current()), value);
}

template class State<2>;
template class State<3>;

}  // namespace grainlaw::core

// Inner product of second-order tensors.
#pragma once

#include "math/tensor.hpp"

#include <cstddef>

namespace grainlaw::core {

template <int D>
double inner(const Tensor<D>& a, const Tensor<D>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < squared<D>; ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace grainlaw::core

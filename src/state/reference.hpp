// Reference configuration of a state that is not its packing's: deformation and stress of the host
// count from there.
#pragma once

#include "math/tensor.hpp"

#include <cstddef>

namespace grainlaw::core {

template <int D>
class Reference {
 public:
  // The packing's deformation gradient where that of the host is I.
  explicit Reference(const Tensor<D>& deformation)
      : deformation_(deformation), volume_(determinant<D>(deformation)) {}

  [[nodiscard]] const Tensor<D>& deformation() const { return deformation_; }
  [[nodiscard]] double volume() const { return volume_; }  // over the packing's own [-]

  [[nodiscard]] Tensor<D> to_packing(const Tensor<D>& F) const {
    return product<D>(F, deformation_);
  }
  [[nodiscard]] Tensor<D> to_host(const Tensor<D>& F) const {
    return F == deformation_ ? identity<D>() : product<D>(F, inverse<D>(deformation_));
  }

  // First Piola-Kirchhoff stress of the host, P G^T / det G.
  [[nodiscard]] Tensor<D> stress_of_host(const Tensor<D>& P) const {
    Tensor<D> result = product<D>(P, transpose<D>(deformation_));
    for (double& component : result) component /= volume_;
    return result;
  }

  // dP/dF of the host: both material indices are carried by G.
  [[nodiscard]] Tensor4<D> tangent_of_host(const Tensor4<D>& A) const {
    Tensor4<D> result{};
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t k = 0; k < D; ++k) {
        Tensor<D> block{};
        for (std::size_t m = 0; m < D; ++m)
          for (std::size_t n = 0; n < D; ++n)
            block[D * m + n] = A[(D * i + m) * squared<D> + D * k + n];
        block = product<D>(product<D>(deformation_, block), transpose<D>(deformation_));
        for (std::size_t j = 0; j < D; ++j)
          for (std::size_t l = 0; l < D; ++l)
            result[(D * i + j) * squared<D> + D * k + l] = block[D * j + l] / volume_;
      }
    }
    return result;
  }

 private:
  Tensor<D> deformation_;
  double volume_;
};

}  // namespace grainlaw::core

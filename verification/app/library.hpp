// The library as the driver uses it: its C++ interface, Eigen types and errors of the program.
#pragma once

#include "base/error.hpp"

#include <grainlaw/grainlaw.hpp>

#include <Eigen/Dense>

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace verification {

// D x D tensors and dP/dF in the row-major order of the C interface: component k = D i + J.
template <int D>
using TensorOf = Eigen::Matrix<double, D, D, Eigen::RowMajor>;
template <int D>
using ComponentsOf = Eigen::Matrix<double, D * D, 1>;
template <int D>
using TangentOf = Eigen::Matrix<double, D * D, D * D, Eigen::RowMajor>;
// Types of discs.
using Tensor = TensorOf<2>;
using Vector4 = ComponentsOf<2>;
using Tangent = TangentOf<2>;

// A computation that failed: the command exits with code 1.
struct ComputationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Wrong input: the command exits with code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Runs an action and translates errors of src/io into errors of the program.
template <class Failure, class Action>
decltype(auto) as(Action&& action) {
  try {
    return action();
  } catch (const grainlaw::core::Error& error) {
    throw Failure(error.what());
  }
}

using grainlaw::Material;
using grainlaw::Points;
using grainlaw::State;

// Throws ComputationError with the status text unless the status is OK.
void check(grainlaw_status status, const std::string& what);

template <int D>
struct EvaluationOf {
  grainlaw_status status = GRAINLAW_OK;
  // First Piola-Kirchhoff stress P [Pa], tension positive, and, when wanted, dP/dF [Pa].
  TensorOf<D> stress = TensorOf<D>::Zero();
  TangentOf<D> tangent = TangentOf<D>::Zero();
  grainlaw_report report = grainlaw_report_default();
};
using Evaluation = EvaluationOf<2>;

// Evaluates a state at the total deformation gradient. A recoverable failure is returned in
// `status`; a fatal one throws ComputationError.
template <int D>
EvaluationOf<D> evaluate_of(State& state, const TensorOf<D>& deformation, unsigned want);
inline Evaluation evaluate(State& state, const Tensor& deformation, unsigned want) {
  return evaluate_of<2>(state, deformation, want);
}

// Bit of `want` for "exact" | "elastic" | "perturbed".
unsigned tangent_bit(const std::string& name);

// All components of a measure, or its first. Throw ComputationError.
std::vector<double> measure(const grainlaw_state* state, grainlaw_measure what);
double measure_scalar(const grainlaw_state* state, grainlaw_measure what);

// F of the trial, found components included.
template <int D>
TensorOf<D> deformation_gradient(const grainlaw_state* state);
inline Tensor deformation_of(const grainlaw_state* state) { return deformation_gradient<2>(state); }

// Cauchy stress sigma = P F^T / det F, @formula stress [Pa].
template <int D>
TensorOf<D> cauchy_stress_of(const TensorOf<D>& stress, const TensorOf<D>& deformation) {
  return stress * deformation.transpose() / deformation.determinant();
}
inline Tensor cauchy_stress(const Tensor& stress, const Tensor& deformation) {
  return cauchy_stress_of<2>(stress, deformation);
}

// dsigma_ij/dF_kL = (A_iMkL F_jM + P_iL delta_jk) / J - sigma_ij F^-1_Lk [Pa].
template <int D>
TangentOf<D> cauchy_tangent(const TensorOf<D>& stress, const TangentOf<D>& tangent,
                            const TensorOf<D>& deformation);

// Components of a tensor as a vector by rows, and back.
template <int D>
ComponentsOf<D> components_of(const TensorOf<D>& tensor) {
  return ComponentsOf<D>::Map(tensor.data());
}
template <int D>
TensorOf<D> tensor_of(const ComponentsOf<D>& components) {
  return TensorOf<D>::Map(components.data());
}
// Components of many tensors, one tensor after the other.
template <class Matrix>
std::span<double> numbers(std::vector<Matrix>& matrices) {
  return {matrices.front().data(), Matrix::SizeAtCompileTime * matrices.size()};
}
inline Vector4 to_vector(const Tensor& tensor) { return components_of<2>(tensor); }
inline Tensor to_tensor(const Vector4& vector) { return tensor_of<2>(vector); }

}  // namespace verification

// The library as the driver sees it: the public C header with handles that close themselves.
#pragma once

#include "base/error.hpp"

#include <grainlaw/grainlaw.h>

#include <Eigen/Dense>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace verification {

// 2 x 2 tensors and dP/dF in the row-major order of the C interface: component k = 2 i + J.
using Tensor = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
using Vector4 = Eigen::Matrix<double, 4, 1>;
using Tangent = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

// A computation that did not succeed: the command ends with exit code 1.
struct ComputationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Input that makes no sense: the command ends with exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What src/io throws, as an error of the program.
template <class Failure, class Action>
decltype(auto) as(Action&& action) {
  try {
    return action();
  } catch (const grainlaw::core::Error& error) {
    throw Failure(error.what());
  }
}

struct MaterialDeleter {
  void operator()(grainlaw_material* material) const { grainlaw_material_destroy(material); }
};
struct StateDeleter {
  void operator()(grainlaw_state* state) const { grainlaw_state_destroy(state); }
};
struct PointsDeleter {
  void operator()(grainlaw_points* points) const { grainlaw_points_destroy(points); }
};
using Material = std::unique_ptr<grainlaw_material, MaterialDeleter>;
using State = std::unique_ptr<grainlaw_state, StateDeleter>;
using Points = std::unique_ptr<grainlaw_points, PointsDeleter>;

// Throws ComputationError with the status text unless the status is OK.
void check(grainlaw_status status, const std::string& what);

// A new integration point at F = I, an independent copy of one, and many. Throw ComputationError.
State make_state(const Material& material);
State clone(const grainlaw_state* state);
Points make_points(const Material& material, std::size_t count);

struct Evaluation {
  grainlaw_status status = GRAINLAW_OK;
  Tensor stress = Tensor::Zero();     // first Piola-Kirchhoff stress P [Pa], tension positive
  Tangent tangent = Tangent::Zero();  // dP/dF [Pa], when wanted
  grainlaw_report report = grainlaw_report_default();
};

// One evaluation at the total deformation gradient; a recoverable failure is left in `status`,
// anything worse throws ComputationError.
Evaluation evaluate(grainlaw_state* state, const Tensor& deformation, unsigned want);

// "exact" | "elastic" | "perturbed" as a bit of `want`.
unsigned tangent_bit(const std::string& name);

// All components of a measure, and the first one. Throw ComputationError.
std::vector<double> measure(const grainlaw_state* state, grainlaw_measure what);
double measure_scalar(const grainlaw_state* state, grainlaw_measure what);

// F of the trial: a boundary with prescribed stresses finds components of its own.
Tensor deformation_of(const grainlaw_state* state);

// sigma = P F^T / det F [Pa].
Tensor cauchy_stress(const Tensor& stress, const Tensor& deformation);

// dsigma_ij/dF_kL = (A_iMkL F_jM + P_iL delta_jk) / J - sigma_ij F^-1_Lk [Pa].
Tangent cauchy_tangent(const Tensor& stress, const Tangent& tangent, const Tensor& deformation);

// The components of a tensor as a vector in the order 11, 12, 21, 22, and back.
inline Vector4 to_vector(const Tensor& tensor) {
  return {tensor(0, 0), tensor(0, 1), tensor(1, 0), tensor(1, 1)};
}
inline Tensor to_tensor(const Vector4& vector) {
  Tensor tensor;
  tensor << vector(0), vector(1), vector(2), vector(3);
  return tensor;
}

}  // namespace verification

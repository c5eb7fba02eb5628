#include "points/consolidate.hpp"

#include "base/error.hpp"
#include "points/stress_path.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Largest difference of sigma_ij from sigma_ji, over the norm.
constexpr double asymmetry = 1e-12;

template <int D>
Tensor<D> scaled(const Tensor<D>& stress, double factor) {
  Tensor<D> result = stress;
  for (double& component : result) component *= factor;
  return result;
}

template <int D>
Vec<D> normal_of(const Consolidation& how) {
  Vec<D> normal{};
  std::copy_n(how.axis.begin(), D, normal.begin());
  return normal;
}

template <int D>
double norm(const Tensor<D>& a) {
  double squares = 0;
  for (const double component : a) squares += component * component;
  return std::sqrt(squares);
}

// "11 -1e+05, 22 -5e+04, 12 0": the upper triangle.
template <int D>
std::string text_of(const Tensor<D>& sigma) {
  std::string text;
  for (std::size_t apart = 0; apart < D; ++apart)
    for (std::size_t i = 0; i + apart < D; ++i)
      text += fmt::format("{}{}{} {:.5g}", text.empty() ? "" : ", ", i + 1, i + apart + 1,
                          sigma[D * i + i + apart] + 0.0);
  return text;
}

template <int D>
double largest_principal(const Tensor<D>& sigma) {
  Eigen::Matrix<double, D, D> matrix;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) matrix(i, j) = sigma[static_cast<std::size_t>(D * i + j)];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>>(matrix)
      .eigenvalues()
      .maxCoeff();
}

template <int D>
void lead_all(StressPath<D>& path, const Tensor<D>& sigma, const Consolidation& how) {
  const Directions<D> all = all_directions<D>();
  if (how.first_pressure > 0) path.lead(all, scaled<D>(identity<D>(), -how.first_pressure));
  const auto there_and_back = [&](const Directions<D>& directions, const Tensor<D>& wanted) {
    if (how.overconsolidation > 1) path.lead(directions, scaled<D>(wanted, how.overconsolidation));
    path.lead(directions, wanted);
  };
  switch (how.route) {
    case StressRoute::isotropic:
      there_and_back(all, scaled<D>(identity<D>(), trace<D>(sigma) / D));
      path.lead(all, sigma);
      return path.settle(all, sigma);
    case StressRoute::proportional:
      there_and_back(all, sigma);
      return path.settle(all, sigma);
    case StressRoute::k0: {
      const Directions<D> traction = directions_of_traction<D>(normal_of<D>(how));
      there_and_back(traction, sigma);
      return path.settle(traction, sigma);
    }
  }
}

template <int D>
Consolidated lead(State<D>& state, const Tensor<D>& sigma, const Consolidation& how,
                  double* reached) {
  Consolidated result;
  StressPath<D> path(state, how.largest_step);
  try {
    lead_all(path, sigma, how);
    state.set_reference_here();
  } catch (const Error& error) {
    result = {error.status,
              fmt::format("carries no more than sigma ({}) Pa on the way to ({}): {}",
                          text_of<D>(path.carried()), text_of<D>(sigma), error.what())};
  }
  std::ranges::copy(path.carried(), reached);
  return result;
}

template <int D>
std::string fault_of(const Material<D>& material, const Tensor<D>& sigma,
                     const Consolidation& how) {
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t j = 0; j < D; ++j)
      if (!std::isfinite(sigma[D * i + j]))
        return fmt::format("sigma{}{} is {}, expected a finite number [Pa]", i + 1, j + 1,
                           sigma[D * i + j]);
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t j = i + 1; j < D; ++j)
      if (!(std::abs(sigma[D * i + j] - sigma[D * j + i]) <= asymmetry * norm<D>(sigma)))
        return fmt::format("sigma{0}{1} is {2:.10g} and sigma{1}{0} is {3:.10g}, expected the same",
                           i + 1, j + 1, sigma[D * i + j], sigma[D * j + i]);
  if (material.space.finds_deformation)
    return "the material has boundary.stress, expected one without: the stress is led by F";
  if (norm<D>(sigma) == 0) return "the stress is 0, expected compression or, with bonds, any other";
  if (material.law.bonds()) return {};
  if (how.route == StressRoute::k0) {
    const Vec<D> normal = normal_of<D>(how);
    const Vec<D> traction = product<D>(sigma, normal);
    const double along = dot<D>(traction.data(), normal.data());
    if (along < 0) return {};
    return fmt::format("the stress along the axis is {:.6g} Pa, expected compression, below 0",
                       along);
  }
  const double largest = largest_principal<D>(sigma);
  if (largest < 0) return {};
  return fmt::format(
      "the largest principal stress is {:.6g} Pa, expected compression, below 0: contacts without "
      "bonds carry no tension",
      largest);
}

}  // namespace

Consolidated consolidate(AnyState& state, const double* sigma, const Consolidation& how,
                         double* reached) {
  return state.visit(
      [&]<int D>(State<D>& of) { return lead<D>(of, tensor_of<D>(sigma), how, reached); });
}

std::string fault_of_stress(const AnyState& state, const double* sigma, const Consolidation& how) {
  return state.visit([&]<int D>(const State<D>& of) {
    return fault_of<D>(of.material(), tensor_of<D>(sigma), how);
  });
}

}  // namespace grainlaw::core

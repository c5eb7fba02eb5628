// What the tests of spheres share: packings, materials, and increments from state to state.
#pragma once

#include "../data.hpp"
#include "homogenise/measures.hpp"
#include "material/packing_file.hpp"
#include "norms.hpp"
#include "packing/geometry.hpp"
#include "state/state.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>

namespace grainlaw::core::sphere_test {

using Deformation = Tensor<3>;
using test::norm;
using test::relative_difference;

// 500 spheres at 100 kPa made with YADE, tests/data.
inline const Packing& reference_packing() {
  static const Packing packing = [] {
    const std::string data = grainlaw::test::data_file("spheres500_");
    return read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"}, 3);
  }();
  return packing;
}

inline MaterialDescription describe(double tolerance = 1e-9) {
  MaterialDescription description;
  description.packing = reference_packing();
  description.law.young = 1e8;
  description.law.ratio = 0.8;
  description.law.friction = std::tan(0.5);
  description.solver.tolerance = tolerance;
  return description;
}

inline MaterialDescription locked(MaterialDescription description) {
  description.law.rotation = false;
  return description;
}

struct Found {
  grainlaw_status status;
  Deformation stress{};
  Tensor4<3> tangent{};
  grainlaw_report report{};
};

inline Found evaluate(State<3>& state, const Deformation& F, TangentKind kind = TangentKind::none) {
  Found found{};
  found.status =
      state.evaluate(F.data(), kind, found.stress.data(), found.tangent.data(), found.report);
  EXPECT_EQ(found.status, GRAINLAW_OK) << found.report.message;
  return found;
}

// About an axis, by an angle [rad].
inline Deformation rotation(Vec<3> axis, double angle) {
  const double size = length<3>(axis);
  for (double& component : axis) component *= std::sin(0.5 * angle) / size;
  const Quaternion q{std::cos(0.5 * angle), axis};
  Deformation result{};
  for (std::size_t m = 0; m < 3; ++m) {
    Vec<3> unit{};
    unit[m] = 1;
    const Vec<3> turned = rotated(q, unit);
    for (std::size_t k = 0; k < 3; ++k) result[3 * k + m] = turned[k];
  }
  return result;
}

// Compressed along one axis, and sheared.
inline Deformation compressed(double strain) {
  return {1 + 0.35 * strain, 0.1 * strain, 0, 0, 1 + 0.35 * strain, 0, 0.1 * strain, 0, 1 - strain};
}

// Both states have had the same increments, the second one turned.
inline void expect_to_turn(State<3>& straight, State<3>& turned, double strain, double bound) {
  for (int n = 1; n <= 3; ++n) {
    const Deformation Q = rotation({1, -2, 0.5}, 0.8 * n);
    const Deformation F = compressed(strain * n);
    const auto stress = evaluate(straight, F).stress;
    const auto found = evaluate(turned, product<3>(Q, F)).stress;
    EXPECT_LT(relative_difference(found, product<3>(Q, stress)), bound) << n;
    straight.commit();
    turned.commit();
  }
}

inline Tensor4<3> central_differences(State<3>& state, const Deformation& F, double step) {
  Tensor4<3> tangent{};
  for (std::size_t k = 0; k < 9; ++k) {
    Deformation stress[2];
    for (int side = 0; side < 2; ++side) {
      Deformation at = F;
      at[k] += side == 0 ? step : -step;
      stress[side] = evaluate(state, at).stress;
    }
    for (std::size_t m = 0; m < 9; ++m) {
      tangent[9 * m + k] = (stress[0][m] - stress[1][m]) / (2 * step);
    }
  }
  return tangent;
}

}  // namespace grainlaw::core::sphere_test

// The exact tangent is the derivative of the stress: against central differences, where no contact
// changes status within the stencil.
#include "tangent_support.hpp"

namespace grainlaw::core::test {
namespace {

TEST(tangent, of_the_periodic_cell_matches_central_differences) {
  expect_derivative_along(describe(small_packing(), rough_law()));
}

TEST(tangent, of_a_frame_matches_central_differences) {
  expect_derivative_along(describe(small_packing(), rough_law(), BoundaryType::frame_p));
}

TEST(tangent, with_locked_rotation_matches_central_differences) {
  expect_derivative_along(describe(small_packing(), locked_law()));
}

TEST(tangent, without_friction_matches_central_differences) {
  // Small packings may not hold without it, or change their contacts within every stencil.
  expect_derivative_along(describe(reference_packing(), smooth_law()));
}

TEST(tangent, of_the_reference_packing_matches_central_differences) {
  expect_derivative_along(describe(reference_packing(), rough_law()));
}

TEST(tangent, through_sub_increments_matches_central_differences) {
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    MaterialDescription description = describe(small_packing(), rough_law(), boundary);
    description.solver.increment_limit = 0.05;
    State state(make_material(description));
    EXPECT_GE(evaluate(state, paths[0].next).report.subincrements, 3);
    expect_derivative_along(description);
  }
}

TEST(tangent, through_sub_increments_of_the_reference_packing_matches_central_differences) {
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    MaterialDescription description = describe(reference_packing(), rough_law(), boundary);
    description.solver.increment_limit = 0.05;
    const auto material = make_material(description);
    for (const Path& path : paths) {
      SCOPED_TRACE(path.name);
      State state(material);
      advance(state, path.reached, path.steps);
      EXPECT_GE(evaluate(state, path.next).report.subincrements, 3);
      expect_derivative(state, path.next);
    }
  }
}

// Where discs that nothing holds at the end of one sub-increment come to bear in a later one. About one
// increment in a hundred ends beside a jump of P.
TEST(tangent, where_rattlers_come_to_bear_rounding_of_F_moves_the_stress_by_rounding) {
  constexpr Tensor increment{5.2e-3, 1.5e-3, 2.5e-3, -5e-3};
  constexpr double rounding = 1e-14;
  int in_parts = 0;
  int rough = 0;
  for (const std::uint64_t seed : {1U, 2U, 4U, 5U}) {
    State state(make_material(
        describe(small_packing(100, seed), rough_law(), BoundaryType::periodic_cell, 1e-11)));
    Tensor F = identity;
    for (int step = 0; step < 4; ++step) {
      F = sum(F, 1, increment);
      const Evaluation at = evaluate(state, F, TangentKind::exact);
      ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
      if (at.report.subincrements > 1 && at.report.history_advanced == 0) {
        ++in_parts;
        EXPECT_EQ(at.report.tangent_exact, 1);
        double largest = 0;
        for (const double sign : {1.0, -1.0}) {
          const Evaluation beside = evaluate(state, sum(F, sign * rounding, {1, -0.5, 0.7, 0.3}));
          largest = std::max(largest, relative_difference(beside.stress, at.stress));
        }
        if (largest > 1e-10) ++rough;
      }
      advance(state, F);
    }
  }
  EXPECT_GE(in_parts, 6);
  EXPECT_LE(rough, 1) << "of " << in_parts;
}

TEST(tangent, turns_the_stress_under_a_spin) {
  constexpr Tensor spin{0, -1, 1, 0};
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    const auto material = make_material(describe(small_packing(), rough_law(), boundary));
    for (const Path& path : paths) {
      State state(material);
      advance(state, path.reached, path.steps);
      for (const double angle : {0.0, 0.7, 3.0}) {
        const Tensor F = product(rotation(angle), path.next);
        const Evaluation at = evaluate(state, F, TangentKind::exact);
        ASSERT_EQ(at.status, GRAINLAW_OK);
        const Tensor change = product(spin, F);
        Tensor by_tangent{};
        for (std::size_t m = 0; m < 4; ++m) {
          for (std::size_t k = 0; k < 4; ++k) by_tangent[m] += at.tangent[m * 4 + k] * change[k];
        }
        EXPECT_LE(relative_difference(by_tangent, product(spin, at.stress)), 1e-9) << path.name;
      }
    }
  }
}

TEST(tangent, by_forward_differences_is_near_the_exact_one) {
  State state(make_material(describe(reference_packing(), rough_law())));
  advance(state, paths[1].reached, paths[1].steps);
  const Evaluation exact = evaluate(state, paths[1].next, TangentKind::exact);
  const Evaluation perturbed = evaluate(state, paths[1].next, TangentKind::perturbed);
  ASSERT_EQ(perturbed.status, GRAINLAW_OK);
  EXPECT_EQ(perturbed.report.tangent_exact, 0);
  EXPECT_EQ(perturbed.stress, exact.stress);
  EXPECT_LE(relative_difference(perturbed.tangent, exact.tangent), 0.01);
}

}  // namespace
}  // namespace grainlaw::core::test

// The exact tangent is the derivative of the stress: against central differences, where no contact
// changes status within the stencil.
#include "tangent_support.hpp"

namespace grainlaw::test {
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

// A rattler left by one sub-increment may come to bear in the next, from a place that no
// equilibrium determines; then the tangent does not claim to be exact.
TEST(tangent, through_sub_increments_is_exact_where_it_says_so) {
  int exact = 0;
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    MaterialDescription description = describe(reference_packing(), rough_law(), boundary);
    description.solver.increment_limit = 0.06;
    const auto material = make_material(description);
    for (const Path& path : paths) {
      SCOPED_TRACE(path.name);
      State state(material);
      advance(state, path.reached, path.steps);
      const Evaluation at = evaluate(state, path.next, TangentKind::exact);
      EXPECT_GE(at.report.subincrements, 3);
      if (at.report.tangent_exact == 0) continue;
      ++exact;
      expect_derivative(state, path.next);
    }
  }
  EXPECT_GE(exact, 3);
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
}  // namespace grainlaw::test

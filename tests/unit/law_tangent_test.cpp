// The exact tangent of every contact law is the derivative of its stress.
#include "boundary_support.hpp"
#include "law_support.hpp"
#include "tangent_support.hpp"

namespace grainlaw::core::test {
namespace {

Packing firmly_held() { return without_rattlers(small_packing()); }

TEST(law_tangent, matches_central_differences) {
  for (const auto& [name, law] : composite_laws()) {
    SCOPED_TRACE(name);
    expect_derivative_along(describe_law(firmly_held(), law));
  }
}

TEST(law_tangent, of_a_frame_matches_central_differences) {
  for (const auto& [name, law] : composite_laws()) {
    SCOPED_TRACE(name);
    expect_derivative_along(describe_law(firmly_held(), law, BoundaryType::frame_p));
  }
}

// F22 is found, and the averages of the top row are held: the border sees the moments too.
TEST(law_tangent, of_a_layer_matches_central_differences) {
  for (const auto& law : {rolling_law(), rolling_hertz_law(), rolling_bonded_law(1)}) {
    MaterialDescription description =
        describe_law(without_rattlers(reference_packing()), law, BoundaryType::mixed);
    description.boundary.sides = layer_sides();
    description.boundary.stress[3] = -1e5;
    State state(make_material(description));
    advance(state, {1, 0.002, 0, 1}, 2);
    expect_derivative(state, {1.0001, 0.0025, 0.0001, 1});
  }
}

TEST(law_tangent, without_tangential_forces_matches_central_differences) {
  expect_derivative_along(describe_law(reference_packing(), smooth_hertz_law()));
}

// Whose tangent is tested with the frictional law.
TEST(law_tangent, of_compressive_contacts_is_that_without_friction) {
  const auto at_next = [](const ContactLaw& law) {
    State state(make_material(describe_law(firmly_held(), law)));
    return evaluate(state, {1.0001, 0, 0, 0.9999}, TangentKind::exact);
  };
  const Evaluation compressive = at_next(compressive_law());
  const Evaluation smooth = at_next(smooth_law());
  ASSERT_EQ(compressive.status, GRAINLAW_OK);
  EXPECT_EQ(compressive.stress, smooth.stress);
  EXPECT_EQ(compressive.tangent, smooth.tangent);
}

TEST(law_tangent, through_sub_increments_matches_central_differences) {
  for (const auto& [name, law] : composite_laws()) {
    SCOPED_TRACE(name);
    MaterialDescription description = describe_law(firmly_held(), law);
    // Away from where the number of parts changes: P jumps there.
    description.solver.increment_limit = law.bonds() ? 2.3 / law.bond.normal_strength : 0.053;
    State state(make_material(description));
    const Evaluation at = evaluate(state, paths[0].next);
    EXPECT_GE(at.report.subincrements, 3);
    expect_derivative_along(description);
  }
}

}  // namespace
}  // namespace grainlaw::core::test

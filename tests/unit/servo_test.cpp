// The published servo and the direct relaxation solve the same equations: they meet.
#include "support.hpp"

namespace grainlaw::test {
namespace {

MaterialDescription servo(double inheritance) {
  MaterialDescription description =
      describe(small_packing(60), rough_law(), BoundaryType::frame_p, 1e-5);
  description.solver.method = Method::published;
  description.boundary.method = BoundaryMethod::servo;
  description.boundary.servo.inheritance = inheritance;
  description.boundary.servo.tolerance = 1e-7;
  return description;
}

// Friction history advanced at every step, as by the servo.
MaterialDescription direct() {
  MaterialDescription description =
      describe(small_packing(60), rough_law(), BoundaryType::frame_p, 1e-6);
  description.solver.method = Method::advancing;
  return description;
}

constexpr double strain = 4e-3;

Tensor sheared(double share) { return {1, strain * share, 0, 1 - 0.3 * strain * share}; }

// Relative difference of P at the end of the path in this many increments.
double difference(double inheritance, int increments) {
  State by_servo(make_material(servo(inheritance)));
  State by_relaxation(make_material(direct()));
  double last = 1;
  for (int k = 1; k <= increments; ++k) {
    const Tensor F = sheared(static_cast<double>(k) / increments);
    const Evaluation a = advance(by_servo, F);
    const Evaluation b = advance(by_relaxation, F);
    EXPECT_GT(a.report.servo_corrections, 0);
    EXPECT_EQ(b.report.servo_corrections, 0);
    EXPECT_EQ(a.report.history_advanced, 1);
    EXPECT_LT(a.report.residual, 1e-3);
    last = relative_difference(a.stress, b.stress);
  }
  return last;
}

TEST(servo, meets_the_direct_relaxation) { EXPECT_LE(difference(1, 4), 1e-3); }

TEST(servo, meets_it_more_closely_with_smaller_increments) { EXPECT_LE(difference(1, 16), 3e-4); }

TEST(servo, without_inheritance_stays_off_by_the_friction_of_starting_over) {
  // Every increment puts the boundary back to F X and slides it to its fluctuation again; the
  // history keeps what slid on the way, whatever the increment.
  const double coarse = difference(0, 4);
  EXPECT_LE(coarse, 1e-2);
  EXPECT_GT(coarse, 5e-3);
  const double fine = difference(0, 12);
  EXPECT_LE(fine, 1e-2);
  EXPECT_GT(fine, 5e-3);
}

TEST(servo, with_and_without_inheritance_agrees_in_the_first_increment) {
  // No fluctuation exists yet that could be inherited.
  State with(make_material(servo(1)));
  State without(make_material(servo(0)));
  const Evaluation a = evaluate(with, sheared(0.25));
  const Evaluation b = evaluate(without, sheared(0.25));
  ASSERT_EQ(a.status, GRAINLAW_OK);
  EXPECT_LE(relative_difference(b.stress, a.stress), 1e-12);
}

TEST(servo, tolerance_bounds_the_boundary_residual) {
  double last = 1;
  for (const double tolerance : {1e-6, 1e-7, 1e-8}) {
    MaterialDescription description = servo(1);
    description.boundary.servo.tolerance = tolerance;
    State state(make_material(description));
    const Evaluation at = evaluate(state, sheared(0.25));
    ASSERT_EQ(at.status, GRAINLAW_OK);
    EXPECT_LT(at.report.residual, 0.2 * last);
    last = at.report.residual;
  }
}

TEST(servo, too_few_corrections_are_recoverable) {
  MaterialDescription description = servo(1);
  description.boundary.servo.max_corrections = 5;
  State state(make_material(description));
  const Configuration before = state.committed();
  Tensor stress{1, 2, 3, 4};
  grainlaw_report report{};
  const Tensor F = sheared(0.25);
  EXPECT_EQ(state.evaluate(F.data(), TangentKind::none, stress.data(), nullptr, report),
            GRAINLAW_NOT_CONVERGED);
  EXPECT_EQ(stress, (Tensor{1, 2, 3, 4}));
  EXPECT_LT(report.step_ratio, 1);
  EXPECT_FALSE(state.has_trial());
  EXPECT_TRUE(same_bits(state.committed(), before));
  // Where it stands there is nothing to correct.
  EXPECT_EQ(evaluate(state, identity).status, GRAINLAW_OK);
}

}  // namespace
}  // namespace grainlaw::test

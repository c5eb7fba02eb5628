// The published servo and the direct relaxation solve the same equations: they meet.
#include "support.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double strain = 1e-3;

Tensor sheared(double share) { return {1, strain * share, 0, 1 - 0.3 * strain * share}; }

MaterialDescription servo(double inheritance, const Packing& packing = reference_packing(),
                          double tolerance = 1e-4) {
  MaterialDescription description =
      describe(packing, rough_law(), BoundaryType::frame_p, tolerance);
  description.solver.method = Method::published;
  description.boundary.method = BoundaryMethod::servo;
  description.boundary.servo.inheritance = inheritance;
  description.boundary.servo.tolerance = 3e-7;
  description.boundary.servo.max_corrections = 2000;
  return description;
}

// Friction history advanced at every step, as by the servo.
MaterialDescription direct(Method method) {
  MaterialDescription description =
      describe(reference_packing(), rough_law(), BoundaryType::frame_p, 1e-4);
  description.solver.method = method;
  return description;
}

// P at the end of the path in this many increments.
Tensor stress_after(int increments, const MaterialDescription& description) {
  State state(make_material(description));
  const bool by_servo = description.boundary.method == BoundaryMethod::servo;
  Tensor stress{};
  for (int k = 1; k <= increments; ++k) {
    const Evaluation at = advance(state, sheared(static_cast<double>(k) / increments));
    if (at.status != GRAINLAW_OK) break;
    EXPECT_EQ(at.report.servo_corrections > 0, by_servo);
    EXPECT_EQ(at.report.history_advanced, 1);
    EXPECT_LT(at.report.residual, 1e-3);
    stress = at.stress;
  }
  return stress;
}

// Relative difference of the servo's P from that of the direct relaxation.
double difference(double inheritance, int increments, Method method = Method::advancing) {
  return relative_difference(stress_after(increments, servo(inheritance)),
                             stress_after(increments, direct(method)));
}

TEST(servo, meets_the_direct_relaxation_in_proportion_to_the_increment) {
  // They slide contacts in another order; how far that matters falls with the increment.
  double last = difference(1, 1);
  for (const int increments : {2, 4}) {
    const double next = difference(1, increments);
    EXPECT_LE(next, 0.55 * last);
    last = next;
  }
  EXPECT_LE(last, 2e-4);
}

TEST(servo, meets_the_direct_relaxation_that_steps_as_it_does) {
  EXPECT_LE(difference(1, 4, Method::published), 1e-4);
}

TEST(servo, without_inheritance_stays_off_by_the_friction_of_starting_over) {
  // Every increment puts the boundary back to F X and slides it to its fluctuation again; the
  // history keeps what slid on the way, and smaller increments start over more often.
  const double coarse = difference(0, 2);
  const double fine = difference(0, 8);
  EXPECT_GT(fine, 1.1 * coarse);
  EXPECT_LE(fine, 2 * coarse);
  EXPECT_GT(fine, 5 * difference(1, 8));
}

TEST(servo, with_and_without_inheritance_agrees_in_the_first_increment) {
  // No fluctuation exists yet that could be inherited.
  State with(make_material(servo(1, small_packing(60), 1e-5)));
  State without(make_material(servo(0, small_packing(60), 1e-5)));
  const Evaluation a = evaluate(with, sheared(1));
  const Evaluation b = evaluate(without, sheared(1));
  ASSERT_EQ(a.status, GRAINLAW_OK);
  EXPECT_LE(relative_difference(b.stress, a.stress), 1e-12);
}

TEST(servo, tolerance_bounds_the_boundary_residual) {
  double last = 1;
  for (const double tolerance : {1e-6, 1e-7, 1e-8}) {
    MaterialDescription description = servo(1, small_packing(60), 1e-5);
    description.boundary.servo.tolerance = tolerance;
    State state(make_material(description));
    const Evaluation at = evaluate(state, sheared(1));
    ASSERT_EQ(at.status, GRAINLAW_OK);
    EXPECT_LT(at.report.residual, 0.2 * last);
    last = at.report.residual;
  }
}

TEST(servo, too_few_corrections_are_recoverable) {
  MaterialDescription description = servo(1, small_packing(60), 1e-5);
  description.boundary.servo.max_corrections = 5;
  State state(make_material(description));
  const Configuration before = state.committed();
  Tensor stress{1, 2, 3, 4};
  grainlaw_report report{};
  const Tensor F = sheared(1);
  EXPECT_EQ(state.evaluate(F.data(), TangentKind::none, stress.data(), nullptr, report),
            GRAINLAW_NOT_CONVERGED);
  EXPECT_EQ(stress, (Tensor{1, 2, 3, 4}));
  EXPECT_LT(report.step_ratio, 1);
  EXPECT_FALSE(state.has_trial());
  EXPECT_TRUE(same_bits(state.committed(), before));
  // Where it stands there is nothing to correct.
  EXPECT_EQ(evaluate(state, identity).status, GRAINLAW_OK);
}

// Both leave out contacts that hardly carry, by the mean force of their own packing.
TEST(servo, does_not_depend_on_what_the_thread_solved_before) {
  const Tensor F = sheared(1);
  ContactLaw stiff = rough_law();
  stiff.young *= 1e4;
  Packing stiff_packing = small_packing();
  for (auto& contact : stiff_packing.contacts) contact.normal_force *= 1e4;
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    const auto make = [&](const Packing& packing, const ContactLaw& law) {
      MaterialDescription description = describe(packing, law, boundary, 1e-4);
      description.solver.method = Method::published;
      return make_material(description);
    };
    State soft(make(small_packing(), rough_law()));
    advance(soft, F);  // springs carry forces along the tangent from here on
    const Tensor next = sheared(2);
    const Tensor expected = evaluate(soft, next).stress;
    EXPECT_EQ(evaluate(soft, next).stress, expected);
    State other(make(stiff_packing, stiff));
    evaluate(other, F);
    EXPECT_EQ(evaluate(soft, next).stress, expected);
  }
}

}  // namespace
}  // namespace grainlaw::core::test

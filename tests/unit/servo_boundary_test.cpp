// The published servo under homogeneous deformation, uniform stress and mixed conditions: it meets
// the direct relaxation of the same increments.
#include "boundary_support.hpp"

namespace grainlaw::core::test {
namespace {

MaterialDescription by_servo(MaterialDescription description) {
  description.solver.method = Method::published;
  description.boundary.method = BoundaryMethod::servo;
  description.boundary.servo.tolerance = 1e-7;
  description.boundary.servo.max_corrections = 5000;
  return description;
}

MaterialDescription by_relaxation(MaterialDescription description) {
  description.solver.method = Method::published;
  return description;
}

Tensor sheared(MaterialDescription description, int increments, long& corrections) {
  State state(make_material(std::move(description)));
  for (int k = 1; k <= increments; ++k) {
    corrections += advance(state, {1, 5e-4 * k / increments, 0, 1}).report.servo_corrections;
  }
  return stress_of(state);
}

double difference(const MaterialDescription& description, int increments, bool corrects) {
  long corrections = 0;
  const Tensor servo = sheared(by_servo(description), increments, corrections);
  EXPECT_EQ(corrections > 0, corrects);
  return relative_difference(servo, sheared(by_relaxation(description), increments, corrections));
}

TEST(servo_boundary, homogeneous_deformation_needs_no_corrections) {  // Table 1
  const auto description = describe(small_packing(60), rough_law(), BoundaryType::frame_d, 1e-5);
  EXPECT_LE(difference(description, 1, false), 1e-3);
}

TEST(servo_boundary, uniform_stress_meets_the_direct_relaxation) {  // Tables 2 and 3
  const auto description = describe(small_packing(60), rough_law(), BoundaryType::frame_t, 1e-4);
  EXPECT_LE(difference(description, 1, true), 1e-3);
}

// What the relaxation's tolerance leaves in 64 inner discs adds up on the boundary to more than the
// servo's: it has to be taken down for the corrections to have an end.
TEST(servo_boundary, forces_left_inside_do_not_stall_the_corrections) {
  ContactLaw law;
  law.normal_stiffness = 1e4;
  law.ratio = 0.2;
  law.friction = 0.4;
  GeneratorOptions lattice;
  lattice.kind = GeneratorKind::square;
  lattice.columns = lattice.rows = 9;
  lattice.radius_max = 1.02e-3;
  lattice.overlap = 0.04e-3;
  lattice.radius_spread = 1e-3;
  lattice.thickness = 1e-3;
  lattice.density = 2000;
  auto description = describe(consolidate(lattice, law), law, BoundaryType::frame_t, 1e-4);
  description.boundary.weight = ContactWeight::one;
  EXPECT_LE(difference(description, 1, true), 1e-4);
}

TEST(servo_boundary, layer_meets_the_direct_relaxation) {  // Table 5
  for (const auto row : {SideRow::discs, SideRow::rigid}) {
    const auto description = describe_layer(small_packing(60), -1e5, row, 1e-4);
    EXPECT_LE(difference(description, 1, true), 1e-3);
  }
}

TEST(servo_boundary, uniform_stress_averages_to_the_deformation) {  // eq. 15
  State state(make_material(
      by_servo(describe(small_packing(60), rough_law(), BoundaryType::frame_t, 1e-4))));
  const Tensor F{1, 5e-4, 0, 1};
  advance(state, F);
  EXPECT_LE(relative_difference(average_deformation(state), F), 1e-6);
}

TEST(servo_boundary, layer_reaches_the_prescribed_stress) {
  State state(
      make_material(by_servo(describe_layer(small_packing(60), -1e5, SideRow::discs, 1e-4))));
  EXPECT_NEAR(advance(state, {1, 5e-4, 0, 1}).stress[3], -1e5, 1e2);
}

}  // namespace
}  // namespace grainlaw::core::test

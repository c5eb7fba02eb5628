// A frame of five sides, four of its discs named as corners: conditions D and T on it (Liu, Bosco & Suiker
// 2017, section 2.1: any shape), with disc radii that differ.
#include "boundary_support.hpp"

#include <numbers>

namespace grainlaw::core::test {
namespace {

constexpr double kn = 1e4, side = 1e-3, tenth = std::numbers::pi / 5;

ContactLaw law_of_discs() {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = 0.2;
  law.friction = 0.4;
  return law;
}

// A rim of five discs on a regular pentagon about a hub; every other disc may be larger.
Packing wheel(double larger = 0) {
  const double around = side / (2 * std::sin(tenth));
  Packing packing;
  packing.thickness = 1e-3;
  packing.cell = {4 * around, 0, 0, 4 * around};
  packing.position.resize(12);
  Frame frame;
  frame.copies = {false, false};
  for (std::size_t q = 0; q < 5; ++q) {
    packing.position[q] = around * std::cos(2 * tenth * static_cast<double>(q));
    packing.position[6 + q] = around * std::sin(2 * tenth * static_cast<double>(q));
    packing.radius.push_back(0.5 * side * (1 + 1e-3 + (q % 2 == 0 ? larger : 0)));
    frame.boundary.push_back(static_cast<int>(q));
  }
  packing.radius.push_back(around - 0.5 * side);
  frame.corner = {0, 1, 2, 3};
  packing.frame = frame;
  complete_frame(packing);
  return packing;
}

TEST(five_sides, areas_close_and_average_positions_to_the_identity) {
  const Packing packing = wheel(0.05);
  const Frame& frame = *packing.frame;
  double closed[2]{};
  Tensor mean{};
  for (std::size_t q = 0; q < 5; ++q) {
    for (std::size_t k = 0; k < 2; ++k) closed[k] += frame.area[q][k] / side;
    for (std::size_t k = 0; k < 4; ++k)
      mean[k] += packing.position[k / 2 * 6 + q] * frame.area[q][k % 2] / polygon_area(packing);
  }
  EXPECT_NEAR(closed[0], 0, 1e-12);
  EXPECT_NEAR(closed[1], 0, 1e-12);
  EXPECT_LE(relative_difference(mean, identity), 1e-12);
}

// Spokes and rim carry kn times their overlap; P is the work of both over the volume.
TEST(five_sides, stress_of_a_wheel_is_that_of_its_springs) {
  constexpr double squeeze = 1e-3;
  const Packing packing = wheel();
  for (const auto type : {BoundaryType::frame_d, BoundaryType::frame_t}) {
    State state(make_material(describe(packing, law_of_discs(), type, 1e-11)));
    const double around = side / (2 * std::sin(tenth)), scale = 1 - squeeze;
    const double rim = kn * (packing.radius[0] + packing.radius[1] - scale * side);
    const double spoke = kn * (packing.radius[0] + packing.radius[5] - scale * around);
    const Evaluation at = advance(state, {scale, 0, 0, scale});
    const double expected =
        -5 * (rim * side + spoke * around) / (2 * polygon_area(packing) * packing.thickness);
    EXPECT_NEAR(at.stress[0] / expected, 1, 1e-7);
    EXPECT_NEAR(at.stress[3] / expected, 1, 1e-7);
    EXPECT_NEAR(at.stress[1] / expected, 0, 1e-7);
  }
}

TEST(five_sides, boundary_makes_the_stress_and_averages_to_the_deformation) {
  const Tensor F{0.9995, 2e-4, 1e-4, 0.9992};
  for (const auto type : {BoundaryType::frame_d, BoundaryType::frame_t}) {
    State state(make_material(describe(wheel(), law_of_discs(), type, 1e-10)));
    const Evaluation at = advance(state, F);
    EXPECT_LT(at.stress[0], 0);
    EXPECT_LE(relative_difference(average_deformation(state), F), 1e-12);
    EXPECT_LE(relative_difference(stress_of_boundary(state), at.stress), 1e-8);
  }
}

}  // namespace
}  // namespace grainlaw::core::test

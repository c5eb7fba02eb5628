// Increments of spheres with drag: the exact tangent, and what turns with the increment.
#include "sphere_support.hpp"

#include <algorithm>

namespace grainlaw::core::sphere_test {
namespace {

std::shared_ptr<const Material<3>> with_drag(long steps) {
  MaterialDescription description = describe();
  description.solver.viscosity.number = 1e-3;
  description.solver.viscosity.steps = steps;
  return make_material<3>(description);
}

TEST(sphere_drag, tangent_matches_central_differences) {
  for (const long steps : {1L, 2L}) {
    State<3> state(with_drag(steps));
    for (int n = 1; n <= 2; ++n) {
      evaluate(state, compressed(1e-3 * n));
      state.commit();
    }
    const auto found = evaluate(state, compressed(3e-3), TangentKind::exact);
    EXPECT_EQ(found.report.tangent_exact, 1);
    double least = 1;
    for (const double step : {1e-6, 1e-7}) {
      const auto differences = central_differences(state, compressed(3e-3), step);
      least = std::min(least, relative_difference(found.tangent, differences));
    }
    EXPECT_LE(least, 1e-6) << steps;
  }
}

TEST(sphere_drag, turns_with_the_increment) {
  const auto material = with_drag(1);
  State<3> straight(material), turned(material);
  expect_to_turn(straight, turned, 1e-3, 1e-8);
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

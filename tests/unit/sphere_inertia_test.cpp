// Volumes of spheres with inertia: the exact tangent, and what turns with the increment.
#include "sphere_support.hpp"

#include <algorithm>

namespace grainlaw::core::sphere_test {
namespace {

constexpr double time_step = 1e-5;  // [s], a fraction of that of a contact, sqrt(m / kn)

std::shared_ptr<const Material<3>> with_inertia() {
  MaterialDescription description = describe();
  description.solver.inertia = true;
  return make_material<3>(description);
}

TEST(sphere_inertia, tangent_matches_central_differences) {
  State<3> state(with_inertia());
  state.set_time_step(time_step);
  for (int n = 1; n <= 3; ++n) {
    evaluate(state, compressed(3e-4 * n));
    state.commit();
  }
  double kinetic = 0;
  measure(state.material().problem(), state.committed(), GRAINLAW_KINETIC_ENERGY, &kinetic);
  ASSERT_GT(kinetic, 0);
  const auto found = evaluate(state, compressed(1.2e-3), TangentKind::exact);
  EXPECT_EQ(found.report.tangent_exact, 1);
  double least = 1;
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    const auto differences = central_differences(state, compressed(1.2e-3), step);
    least = std::min(least, relative_difference(found.tangent, differences));
  }
  EXPECT_LE(least, 1e-6);
}

TEST(sphere_inertia, turns_with_the_increment) {
  const auto material = with_inertia();
  State<3> straight(material), turned(material);
  for (State<3>* state : {&straight, &turned}) state->set_time_step(time_step);
  expect_to_turn(straight, turned, 3e-4, 1e-7);
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

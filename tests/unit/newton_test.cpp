// Newton from where a relaxation ends.
#include "equilibrium/newton.hpp"
#include "equilibrium/relaxation.hpp"
#include "support.hpp"

namespace grainlaw::test {
namespace {

// Shear through the peak, each increment from the equilibrium of the last. Where contacts go on
// switching, either may give up.
TEST(newton, solves_nine_of_ten_increments_from_where_a_relaxation_ends) {
  constexpr int increments = 100;
  State state(
      make_material(describe(reference_packing(), rough_law(), BoundaryType::periodic_cell)));
  RelaxationMemory relaxation;
  NewtonMemory newton;
  int solved = 0;
  for (int k = 1; k <= increments; ++k) {
    const Tensor F{1, 2e-3 * k, 0, 1};
    const Problem problem = state.material().problem();
    Increment increment;
    increment.begin(problem, state.committed(), F);
    increment.refresh_masses();
    const bool relaxed = relax(increment, 5e-4, 5000, History::committed, relaxation);
    if (relaxed && flow_newton(increment, 1e-8, 50, newton)) ++solved;
    advance(state, F);
  }
  EXPECT_GE(solved, increments * 9 / 10);
}

}  // namespace
}  // namespace grainlaw::test

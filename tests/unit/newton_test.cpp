// Newton from where a relaxation ends.
#include "equilibrium/newton.hpp"
#include "equilibrium/relaxation.hpp"
#include "support.hpp"

namespace grainlaw::core::test {
namespace {

struct Found {
  int solved = 0, factorisations = 0;
};

// Shear through the peak, each increment from the equilibrium of the last. Where contacts go on
// switching, either may give up.
Found solve_from_relaxed(int increments, RelaxationMemory* settling) {
  State state(
      make_material(describe(reference_packing(), rough_law(), BoundaryType::periodic_cell)));
  RelaxationMemory relaxation;
  NewtonMemory newton;
  Found found;
  for (int k = 1; k <= increments; ++k) {
    const Tensor F{1, 2e-3 * k, 0, 1};
    const Problem problem = state.material().problem();
    Increment increment;
    increment.begin(problem, state.committed(), F);
    increment.refresh_masses();
    const bool relaxed = relax(increment, 5e-4, 5000, History::committed, relaxation);
    if (relaxed && pseudo_transient_newton(increment, 1e-8, 50, newton, settling)) ++found.solved;
    found.factorisations += increment.cost.factorisations;
    advance(state, F);
  }
  return found;
}

TEST(newton, solves_nine_of_ten_increments_from_where_a_relaxation_ends) {
  EXPECT_GE(solve_from_relaxed(100, nullptr).solved, 90);
}

// What a step leaves around single contacts.
TEST(newton, relaxations_between_its_steps_spare_factorisations) {
  RelaxationMemory settling;
  const Found settled = solve_from_relaxed(50, &settling);
  EXPECT_GE(settled.solved, 45);
  EXPECT_LT(settled.factorisations, 0.8 * solve_from_relaxed(50, nullptr).factorisations);
}

}  // namespace
}  // namespace grainlaw::core::test

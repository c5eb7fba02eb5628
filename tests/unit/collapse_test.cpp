// Under uniform stress a packing without cohesion is in equilibrium without any stress as well:
// never taken for an answer.
#include "boundary_support.hpp"

namespace grainlaw::core::test {
namespace {

TEST(collapse, is_a_status_of_its_own_and_changes_nothing) {
  State state(make_material(describe(small_packing(), rough_law(), BoundaryType::frame_t, 1e-6)));
  const double start = std::abs(stress_of(state)[3]);
  Configuration before = state.committed();
  grainlaw_status status = GRAINLAW_OK;
  for (int step = 1; status == GRAINLAW_OK && step <= 100; ++step) {
    const double strain = 2e-3 * step;
    const auto result = evaluate(state, {1 + 0.5 * strain, strain, 0, 1 + 0.5 * strain});
    status = result.status;
    if (status != GRAINLAW_OK) {
      EXPECT_STREQ(result.report.message, grainlaw_status_text(status));
      EXPECT_LT(result.report.step_ratio, 1);
      break;
    }
    EXPECT_GT(std::abs(result.stress[0]) + std::abs(result.stress[3]), 1e-3 * start);
    state.commit();
    before = state.committed();
  }
  EXPECT_EQ(status, GRAINLAW_COLLAPSED);
  EXPECT_TRUE(same_bits(before, state.committed()));
}

}  // namespace
}  // namespace grainlaw::core::test

// Increments that may end at a looser residual where their packing does not settle soon.
#include "law_support.hpp"

namespace grainlaw::test {
namespace {

constexpr double tolerance = 1e-8;
constexpr double loose = 1e-2;

// Through the peak of simple compression at constant area; both start every increment where the one
// with full effort ended the last.
TEST(loose_tolerance, ends_where_a_packing_does_not_settle_and_changes_nothing_elsewhere) {
  auto description = describe(small_packing(100, 3), rough_law(), BoundaryType::periodic_cell);
  description.solver.tolerance = tolerance;
  const auto material = make_material(description);
  description.solver.loose_tolerance = loose;
  const auto bounded = make_material(description);
  State full(material);
  State state(bounded);
  int same = 0;
  int ended_loosely = 0;
  for (int k = 1; k <= 25; ++k) {
    const Tensor F{1 + 1e-3 * k, 0, 0, 1 - 1e-3 * k};
    const Evaluation expected = evaluate(full, F, TangentKind::exact);
    const Evaluation at = evaluate(state, F, TangentKind::exact);
    ASSERT_EQ(at.status, GRAINLAW_OK) << k;
    EXPECT_LE(at.report.residual, loose);
    if (at.stress == expected.stress && at.tangent == expected.tangent) ++same;
    if (at.report.residual > tolerance) {
      ++ended_loosely;
      EXPECT_LT(relative_difference(at.stress, expected.stress), 1e-3) << k;
    }
    full.commit();
    state.restore(full.committed());
  }
  EXPECT_GE(same, 22);
  EXPECT_GE(ended_loosely, 1);
}

}  // namespace
}  // namespace grainlaw::test

// A guess says where the iteration starts; one that leads nowhere costs no answer.
#include "support.hpp"

#include <limits>

namespace grainlaw::core::test {
namespace {

TEST(guess, that_lets_positions_run_away_is_dropped_for_the_committed_start) {
  const auto material = make_material(describe(small_packing(), rough_law()));
  const Problem problem = material->problem();
  Request request{&problem, &material->solver, &material->initial, {1.0003, 1e-4, -1e-4, 0.9994}};
  Workspace fresh;
  ASSERT_EQ(solve(request, fresh).status, GRAINLAW_OK);
  for (const double away : {1e300, std::numeric_limits<double>::quiet_NaN()}) {
    const std::vector<double> guess(material->initial.coordinates.size(), away);
    request.guess = &guess;
    request.guess_deformation = request.deformation;
    Workspace workspace;
    EXPECT_EQ(solve(request, workspace).status, GRAINLAW_OK) << away;
    EXPECT_EQ(workspace.increment.motion().coordinates(), fresh.increment.motion().coordinates());
  }
}

}  // namespace
}  // namespace grainlaw::core::test

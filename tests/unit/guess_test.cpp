// A guess says where the iteration starts; one that leads nowhere costs no answer.
#include "boundary_support.hpp"
#include "law_support.hpp"
#include "sphere_support.hpp"
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

// Evaluates at `to` after a trial at `from`, with and without the tangent there.
template <class StateOfDimension, class Material, class Deformation>
void expect_that_the_tangent_leads_on(const Material& material, const Deformation& from,
                                      const Deformation& to) {
  const auto answer_after = [&](TangentKind kind) {
    StateOfDimension state(material);
    std::array<double, 81> any{};
    Deformation stress{};
    grainlaw_report report{};
    EXPECT_EQ(state.evaluate(from.data(), kind, stress.data(), any.data(), report), GRAINLAW_OK);
    EXPECT_EQ(state.evaluate(to.data(), TangentKind::none, stress.data(), nullptr, report = {}),
              GRAINLAW_OK);
    EXPECT_LT(report.residual, material->solver.tolerance);
    return std::pair(stress, report);
  };
  const auto [led, with] = answer_after(TangentKind::exact);
  const auto [stress, without] = answer_after(TangentKind::none);
  EXPECT_LT(relative_difference(led, stress), 10 * material->solver.tolerance);
  EXPECT_LT(with.relaxation_steps, without.relaxation_steps);
  EXPECT_LE(with.factorisations, without.factorisations);
}

TEST(guess, from_a_trial_follows_its_tangent) {
  for (const double number : {0.0, 1e-3}) {
    for (const auto type :
         {BoundaryType::periodic_cell, BoundaryType::frame_p, BoundaryType::frame_d}) {
      SCOPED_TRACE(std::to_string(number) + " " + std::to_string(static_cast<int>(type)));
      auto description = describe_law(reference_packing(), rough_law(), type);
      description.solver.viscosity.number = number;
      description.solver.start = Start::trial;
      const auto material = make_material(description);
      expect_that_the_tangent_leads_on<State>(material, Tensor{1.0002, 1e-4, -1e-4, 0.9994},
                                              Tensor{1.00022, 1e-4, -1.2e-4, 0.99935});
    }
  }
}

TEST(guess, of_spheres_from_a_trial_follows_its_tangent) {
  for (const double number : {0.0, 1e-3}) {
    SCOPED_TRACE(number);
    auto description = sphere_test::describe();
    description.solver.viscosity.number = number;
    description.solver.start = Start::trial;
    const auto material = core::make_material<3>(description);
    expect_that_the_tangent_leads_on<core::State<3>>(
        material, core::Tensor<3>{1.0002, 1e-4, 0, 0, 1.0001, 0, 0, -1e-4, 0.9994},
        core::Tensor<3>{1.00022, 1.2e-4, 0, 2e-5, 1.00012, 0, 0, -1e-4, 0.99935});
  }
}

}  // namespace
}  // namespace grainlaw::core::test

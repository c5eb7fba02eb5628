// The stiffness is the derivative of the residual, and solves with it invert it. What it keeps for
// the rest of an increment changes no bit of another.
#include "support.hpp"

#include "equilibrium/strategy.hpp"

#include <span>

namespace grainlaw::core::test {
namespace {

std::vector<MaterialDescription> descriptions() {
  std::vector<MaterialDescription> all;
  for (const auto& law : {rough_law(), locked_law(), smooth_law()}) {
    for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
      all.push_back(describe(small_packing(), law, boundary));
    }
  }
  return all;
}

constexpr Tensor next{1.0003, 1e-4, -1e-4, 0.9994};

// An equilibrium and all memory that led there.
struct Solved {
  std::shared_ptr<const Material> material;
  Problem problem;
  Workspace workspace;

  explicit Solved(const MaterialDescription& description)
      : material(make_material(description)), problem(material->problem()) {
    Request request{&problem, &material->solver, &material->initial, next};
    request.tolerance = 1e-10;
    request.sensitivities = true;
    EXPECT_EQ(solve(request, workspace).status, GRAINLAW_OK);
  }
  Increment& increment() { return workspace.increment; }
  Stiffness& stiffness() { return workspace.newton.stiffness; }
};

double largest(std::span<const double> values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

// Different on every unknown; translations of fixed nodes do not move.
std::vector<double> some_motion(const Increment& increment, double size) {
  std::vector<double> motion(increment.problem().unknowns());
  const auto nodes = increment.problem().nodes();
  const auto& space = *increment.problem().space;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const double lever = k < 2 * nodes ? 1 : increment.motion().node_radius()[k % nodes];
    motion[k] = size / lever * std::sin(1 + 0.7 * static_cast<double>(k));
    if (k < 2 * nodes && !space.identity && space.fixed[k % nodes]) motion[k] = 0;
  }
  return motion;
}

// -dr along the motion, by central differences.
std::vector<double> force_change(Increment& increment, std::span<const double> motion) {
  const auto before = increment.motion().coordinates();
  std::vector<double> change(motion.size());
  for (const double side : {1.0, -1.0}) {
    increment.motion().go_to(before, increment.motion().deformation());
    increment.motion().move(motion, side);
    increment.update_forces();
    for (std::size_t k = 0; k < change.size(); ++k) change[k] -= side * increment.residual()[k] / 2;
  }
  increment.motion().go_to(before, increment.motion().deformation());
  increment.update_forces();
  return change;
}

TEST(stiffness, takes_the_change_of_the_residual_back_to_the_motion) {
  for (const auto& description : descriptions()) {
    Solved solved(description);
    auto& increment = solved.increment();
    // Rattlers are at the point of touching: away from there no status changes.
    increment.motion().move(some_motion(increment, 1e-7));
    constexpr double size = 1e-10;
    constexpr double shift = 0.1;  // holds what no contact holds
    const auto motion = some_motion(increment, size);
    auto right = force_change(increment, motion);
    for (std::size_t k = 0; k < right.size(); ++k)
      right[k] += shift * increment.masses().of_unknowns()[k] * motion[k];
    std::vector<double> x(motion.size());
    solved.stiffness().assemble(increment, shift);
    solved.stiffness().factorise(increment);
    ASSERT_TRUE(solved.stiffness().solve(increment, right, x));
    const auto nodes = increment.problem().nodes();
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double lever = k < 2 * nodes ? 1 : increment.motion().node_radius()[k % nodes];
      EXPECT_NEAR(x[k] * lever, motion[k] * lever, 1e-4 * size) << k;
    }
  }
}

TEST(stiffness, solves_four_as_one_by_one) {
  for (const auto& description : descriptions()) {
    Solved solved(description);
    auto& increment = solved.increment();
    auto& stiffness = solved.stiffness();
    const auto nodes = increment.problem().nodes();
    const auto b = increment.problem().unknowns() / nodes;
    std::vector<double> right(increment.problem().unknowns());
    std::vector<double> x(right.size());
    std::vector<Together<4>> four(right.size());
    std::vector<Together<4>> solution(right.size());
    const auto right_side = [&](std::size_t lane) {
      const auto motion = some_motion(increment, static_cast<double>(1 + lane));
      for (std::size_t k = 0; k < right.size(); ++k)
        right[k] = increment.masses().of_unknowns()[k] * motion[k];
    };
    for (std::size_t l = 0; l < 4; ++l) {
      right_side(l);
      for (std::size_t k = 0; k < right.size(); ++k) {
        four[k % nodes * b + k / nodes].lane[l] = right[k];
      }
    }
    stiffness.assemble(increment, 1e-3);
    ASSERT_TRUE(stiffness.solve_together(increment, four, solution));
    stiffness.factorise(increment);
    for (std::size_t l = 0; l < 4; ++l) {
      right_side(l);
      ASSERT_TRUE(stiffness.solve(increment, right, x));
      std::vector<double> difference(x);
      for (std::size_t k = 0; k < x.size(); ++k) {
        difference[k] -= solution[k % nodes * b + k / nodes].lane[l];
      }
      EXPECT_LE(largest(difference), 1e-8 * largest(x));
    }
  }
}

TEST(stiffness, keeps_nothing_that_changes_another_increment) {
  // On this thread's memory: alone, after others, and after itself along another way.
  const auto material = make_material(describe(small_packing(), rough_law()));
  const auto evaluations = [&] {
    std::vector<Evaluation> result;
    State state(material);
    for (const double strain : {2e-4, 6e-4, 1.2e-3}) {
      result.push_back(
          evaluate(state, {1 + 0.4 * strain, strain / 2, 0, 1 - strain}, TangentKind::exact));
      EXPECT_EQ(result.back().status, GRAINLAW_OK);
      state.commit();
    }
    return result;
  };
  const auto alone = evaluations();
  const auto disturb = [&](const std::shared_ptr<const Material>& other, double shear) {
    State state(other);
    evaluate(state, {1, shear, 0, 0.999}, TangentKind::exact);
    evaluate(state, {1, shear, 0, 0.9985}, TangentKind::none);
  };
  const std::vector<std::shared_ptr<const Material>> others{
      material, make_material(describe(small_packing(), locked_law())),
      make_material(describe(small_packing(), rough_law(), BoundaryType::frame_p)),
      make_material(describe(small_packing(60, 2), smooth_law()))};
  for (const auto& other : others) {
    disturb(other, 1e-3);
    const auto again = evaluations();
    for (std::size_t k = 0; k < alone.size(); ++k) {
      EXPECT_EQ(again[k].stress, alone[k].stress);
      EXPECT_EQ(again[k].tangent, alone[k].tangent);
    }
  }
}

}  // namespace
}  // namespace grainlaw::core::test

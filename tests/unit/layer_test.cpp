// The infinite layer of Liu, Bosco & Suiker (2017), section 5: sheared under a prescribed vertical
// stress, F22 found.
#include "base/error.hpp"
#include "boundary_support.hpp"
#include "frame/frame_space.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double pressure = -1e5;

double f22(const State& state) { return state.current().deformation[3]; }

TEST(layer, returns_the_prescribed_stress_whatever_f22_is_given) {
  for (const auto row : {SideRow::discs, SideRow::rigid}) {
    State state(make_material(describe_layer(small_packing(), pressure, row)));
    EXPECT_NEAR(stress_of(state)[3], pressure, 1e-8 * std::abs(pressure));
    Tensor expected{};
    for (const double ignored : {1.0, 0.7, -3.0}) {
      const auto result = evaluate(state, {1, 5e-4, 0, ignored});
      ASSERT_EQ(result.status, GRAINLAW_OK) << result.report.message;
      EXPECT_NEAR(result.stress[3], pressure, 1e-8 * std::abs(pressure));
      if (ignored == 1.0) expected = result.stress;
      EXPECT_EQ(result.stress, expected);
    }
    double reported[4];
    measure(state.material().problem(), state.current(), GRAINLAW_DEFORMATION_GRADIENT, reported);
    EXPECT_EQ(reported[1], 5e-4);
    EXPECT_EQ(reported[3], f22(state));
    EXPECT_NE(reported[3], 1);
  }
}

TEST(layer, found_deformation_gives_the_prescribed_stress_when_it_is_given) {
  State found(make_material(describe_layer(small_packing(), pressure)));
  // Here F22 is given: the packing as it stands is loaded by the path found above.
  auto description = describe_layer(small_packing(), pressure);
  description.boundary.stress = {};
  State given(make_material(description));
  advance(given, {1, 0, 0, f22(found)}, 5);
  EXPECT_NEAR(stress_of(given)[3], pressure, 1e-3 * std::abs(pressure));
}

TEST(layer, counts_bonds_that_the_prescribed_stress_breaks) {
  auto description = describe_layer(small_packing(), 4 * pressure);
  description.law.kind = LawKind::bonded;
  description.law.bond.bending_stiffness = 1e-3;
  for (const bool weak : {true, false}) {
    description.law.bond.normal_strength = description.law.bond.tangential_strength =
        description.law.bond.bending_strength = weak ? 0.1 : 1e6;
    EXPECT_EQ(make_material(description)->initial.broken_bonds > 0, weak);
  }
}

TEST(layer, tangent_is_condensed) {
  State state(make_material(describe_layer(small_packing(), 1.1 * pressure)));
  for (const auto kind : {TangentKind::exact, TangentKind::elastic}) {
    const auto result = evaluate(state, {1, 1e-4, 0, 1}, kind);
    ASSERT_EQ(result.status, GRAINLAW_OK) << result.report.message;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(result.tangent[4 * 3 + k], 0);
      EXPECT_EQ(result.tangent[4 * k + 3], 0);
    }
    EXPECT_GT(result.tangent[5], 0);  // dP12 / dF12
  }
}

// Discs that F12 moves by their heights press their neighbours in the row, an elastic skeleton
// beside the packing; a rigid row has no contacts within.
TEST(layer, rigid_rows_carry_no_load_of_their_own) {
  for (const auto row : {SideRow::discs, SideRow::rigid}) {
    State state(make_material(describe_layer(small_packing(), pressure, row, 1e-8)));
    advance(state, {1, 2e-3, 0, 1}, 2);
    // The rows, whatever the option.
    const auto rows =
        make_boundary_space(state.material().packing,
                            describe_layer(small_packing(), pressure, SideRow::rigid).boundary)
            .rows;
    double within = 0;
    for (const auto& c : contact_views(state.material().problem(), state.current())) {
      const bool both =
          (rows[static_cast<std::size_t>(c.i)] & rows[static_cast<std::size_t>(c.j)]) != 0;
      if (both) within += c.normal_force;
    }
    EXPECT_EQ(within > 0, row == SideRow::discs);
  }
}

TEST(layer, rigid_row_moves_as_one_body) {
  State state(make_material(describe_layer(small_packing(), pressure, SideRow::rigid)));
  const auto& packing = state.material().packing;
  const auto n = packing.size();
  const std::vector<double> before = state.current().coordinates;
  advance(state, {1, 1e-3, 0, 1});
  const auto& after = state.current().coordinates;
  for (const unsigned side : {1U, 4U}) {  // bottom, top
    double move[2][2] = {{1, -1}, {1, -1}};
    for (std::size_t p = 0; p < n; ++p) {
      if ((state.material().space.rows[p] & side) == 0) continue;
      for (std::size_t k = 0; k < 2; ++k) {
        const double by = after[k * n + p] - before[k * n + p];
        move[k][0] = std::min(move[k][0], by);
        move[k][1] = std::max(move[k][1], by);
      }
    }
    EXPECT_NEAR(move[0][1], move[0][0], 1e-14);
    EXPECT_NEAR(move[1][1], move[1][0], 1e-14);
  }
}

TEST(layer, stress_that_no_state_carries_is_refused_by_name) {
  try {
    make_material(describe_layer(small_packing(), 2e4));  // tension, without cohesion
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_GT(error.status, 0);
    EXPECT_NE(std::string(error.what()).find("P22 = 20000 Pa"), std::string::npos) << error.what();
  }
}

TEST(layer, start_from_the_trial_finds_the_same_state) {
  auto description = describe_layer(small_packing(), pressure);
  State committed(make_material(description));
  description.solver.start = Start::trial;
  State trial(make_material(description));
  evaluate(trial, {1, 4e-4, 0, 1});
  const Tensor F{1, 5e-4, 0, 1};
  const auto expected = evaluate(committed, F);
  EXPECT_LE(relative_difference(evaluate(trial, F).stress, expected.stress), 1e-7);
}

}  // namespace
}  // namespace grainlaw::core::test

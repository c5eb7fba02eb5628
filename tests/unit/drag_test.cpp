// Increments with drag: exact tangents, objectivity, no jumps, and nothing that equilibrium does not have.
#include "boundary_support.hpp"
#include "law_support.hpp"
#include "state/serialise.hpp"
#include "tangent_support.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr Tensor drained_step{0.35e-3, 1e-4, -1e-4, -1e-3};

MaterialDescription with_drag(MaterialDescription description, double time = 100, long steps = 1) {
  description.solver.viscosity.time = time;
  description.solver.viscosity.steps = steps;
  return description;
}

// Committed states on a path that shears and compresses, of which each increment is balanced.
void lead(State& state, int steps) {
  Tensor F = state.committed().deformation;
  for (int n = 0; n < steps; ++n) {
    F = sum(F, 1, drained_step);
    const Evaluation at = evaluate(state, F);
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    EXPECT_LE(at.report.residual, state.material().solver.tolerance);
    state.commit();
  }
}

Tensor next_of(const State& state) { return sum(state.committed().deformation, 1, drained_step); }

TEST(drag, tangent_matches_central_differences) {
  for (const long steps : {1L, 3L}) {
    SCOPED_TRACE(steps);
    State state(make_material(with_drag(describe(reference_packing(), rough_law()), 100, steps)));
    for (int n = 0; n < 5; ++n) {
      lead(state, 2);
      expect_derivative(state, next_of(state));
    }
  }
}

TEST(drag, tangent_of_every_law_and_boundary_matches_central_differences) {
  for (const auto& [name, law] : composite_laws()) {
    for (const auto type : {BoundaryType::periodic_cell, BoundaryType::frame_p,
                            BoundaryType::frame_d, BoundaryType::frame_t}) {
      SCOPED_TRACE(std::string(name) + ", boundary " + std::to_string(static_cast<int>(type)));
      State state(make_material(with_drag(describe_law(small_packing(), law, type), 100, 2)));
      lead(state, 2);
      expect_derivative(state, next_of(state));
    }
  }
}

// F22 is found, and what the drag expects moves with it.
TEST(drag, tangent_of_a_layer_matches_central_differences) {
  for (const long steps : {1L, 2L}) {
    MaterialDescription description =
        with_drag(describe(reference_packing(), rough_law(), BoundaryType::mixed), 100, steps);
    description.boundary.sides = layer_sides();
    description.boundary.stress[3] = -1e5;
    State state(make_material(description));
    advance(state, {1, 0.002, 0, 1}, 2);
    expect_derivative(state, {1.0001, 0.0025, 0.0001, 1});
  }
}

// In a held packing drag goes on to fade: moves without a strain, which no next strain continues.
TEST(drag, moves_of_a_held_packing_are_not_expected_again) {
  for (const double held : {0.0, 1e-9, 1e-7}) {
    SCOPED_TRACE(held);
    State state(make_material(with_drag(describe(reference_packing(), rough_law()))));
    lead(state, 3);
    evaluate(state, sum(state.committed().deformation, held, drained_step));
    state.commit();
    expect_derivative(state, state.committed().deformation);
  }
}

TEST(drag, turns_with_the_increment) {
  const auto material = make_material(with_drag(describe(reference_packing(), rough_law())));
  State straight(material), turned(material);
  Tensor F = identity;
  for (int n = 0; n < 4; ++n) {
    F = sum(F, 1, drained_step);
    const Tensor Q = rotation(0.9 * (n + 1));
    const Tensor stress = evaluate(straight, F).stress;
    EXPECT_LT(relative_difference(evaluate(turned, product(Q, F)).stress, product(Q, stress)), 1e-8)
        << n;
    straight.commit();
    turned.commit();
  }
}

TEST(drag, goes_on_from_saved_bytes_with_the_same_bits) {
  const auto material = make_material(with_drag(describe(small_packing(), rough_law())));
  State state(material), loaded(material);
  lead(state, 3);
  std::vector<std::byte> bytes(saved_size(*material, state.committed()));
  save_configuration(*material, state.committed(), bytes);
  loaded.restore(load_configuration(*material, std::span<const std::byte>(bytes)));
  const Tensor F = next_of(state);
  const Evaluation here = evaluate(state, F, TangentKind::exact);
  const Evaluation there = evaluate(loaded, F, TangentKind::exact);
  EXPECT_EQ(here.stress, there.stress);
  EXPECT_EQ(here.tangent, there.tangent);
}

// The longer an increment takes, the nearer it comes to equilibrium.
TEST(drag, fades_with_the_time_of_an_increment) {
  const Tensor F = sum(identity, 1, drained_step);
  const auto at = [&](double time) {
    State state(make_material(with_drag(describe(small_packing(), rough_law()), time)));
    return evaluate(state, F);
  };
  State balanced(make_material(describe(small_packing(), rough_law())));
  const Tensor equilibrium = evaluate(balanced, F).stress;
  double last = 1, last_unbalanced = 1;
  for (const double time : {1e2, 1e4, 1e6}) {
    const Evaluation found = at(time);
    const double difference = relative_difference(found.stress, equilibrium);
    EXPECT_LT(difference, 0.1 * last) << time;
    EXPECT_LT(found.report.unbalanced, 0.1 * last_unbalanced) << time;
    last = difference;
    last_unbalanced = found.report.unbalanced;
  }
}

// An increment, and two halves of half its time, lead to about the same P. Increments of one time,
// however long they are, would not: more of them would take longer.
TEST(drag, parts_of_an_increment_take_its_time_together) {
  MaterialDescription whole = with_drag(describe(small_packing(), rough_law()), 3);
  MaterialDescription in_parts = whole;
  in_parts.solver.viscosity.steps = 2;
  State a(make_material(in_parts)), b(make_material(whole));
  constexpr Tensor stretch{0.35e-3, 0, 0, -1e-3};
  const Tensor F = sum(identity, 1, stretch);
  whole.solver.viscosity.increment = 1;
  State timed(make_material(whole));
  timed.set_time_step(0.5);
  evaluate(timed, sum(identity, 0.5, stretch));
  timed.commit();
  const Tensor in_halves = evaluate(timed, F).stress;
  // Parts go on as they went; halves as much as their strains are the same.
  EXPECT_LT(relative_difference(in_halves, evaluate(a, F).stress), 1e-5);
  EXPECT_GT(relative_difference(in_halves, evaluate(b, F).stress), 1e-4);
}

// Else P would jump where F asks for one part more, and no host would balance it there.
TEST(drag, number_of_parts_does_not_follow_the_size_of_an_increment) {
  const auto at = [](double limit) {
    MaterialDescription description = with_drag(describe(small_packing(), rough_law()));
    description.solver.increment_limit = limit;
    State state(make_material(description));
    return evaluate(state, sum(identity, 1, drained_step));
  };
  const Evaluation hard = at(0.05);
  EXPECT_EQ(hard.report.subincrements, 1);
  EXPECT_EQ(hard.stress, at(1e3).stress);
}

TEST(drag, reversal_expects_no_move) {
  State state(make_material(with_drag(describe(small_packing(), rough_law()))));
  lead(state, 3);
  State fresh(make_material(with_drag(describe(small_packing(), rough_law()))));
  Configuration at_rest = state.committed();
  at_rest.move.clear();
  at_rest.move_stretch = {};
  fresh.restore(at_rest);
  const Tensor back = sum(state.committed().deformation, -1, drained_step);
  EXPECT_EQ(evaluate(state, back).stress, evaluate(fresh, back).stress);
}

}  // namespace
}  // namespace grainlaw::core::test

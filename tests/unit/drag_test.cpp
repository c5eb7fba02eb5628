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

MaterialDescription with_drag(MaterialDescription description, double number = 1e-3,
                              long steps = 1) {
  description.solver.viscosity.number = number;
  description.solver.viscosity.steps = steps;
  return description;
}

// The host's time: an increment that was told 1 lasts one memory.
MaterialDescription in_time(MaterialDescription description) {
  description = with_drag(std::move(description));
  description.solver.viscosity.rate = description.solver.viscosity.number;
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
    State state(make_material(with_drag(describe(reference_packing(), rough_law()), 1e-3, steps)));
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
      State state(make_material(with_drag(describe_law(small_packing(), law, type), 1e-3, 2)));
      lead(state, 2);
      expect_derivative(state, next_of(state));
    }
  }
}

// F22 is found, and what the drag expects moves with it.
TEST(drag, tangent_of_a_layer_matches_central_differences) {
  for (const long steps : {1L, 2L}) {
    MaterialDescription description =
        with_drag(describe(reference_packing(), rough_law(), BoundaryType::mixed), 1e-3, steps);
    description.boundary.sides = layer_sides();
    description.boundary.stress[3] = -1e5;
    State state(make_material(description));
    advance(state, {1, 0.002, 0, 1}, 2);
    expect_derivative(state, {1.0001, 0.0025, 0.0001, 1});
  }
}

TEST(drag, tangent_at_a_reversal_matches_central_differences) {
  for (const long steps : {1L, 2L}) {
    for (const double back : {-1.0, -0.3, -0.02}) {
      SCOPED_TRACE(std::to_string(steps) + " parts, back by " + std::to_string(back));
      State state(
          make_material(with_drag(describe(reference_packing(), rough_law()), 1e-3, steps)));
      lead(state, 4);
      // Aside too, where the drag softens in part.
      const Tensor to = sum(state.committed().deformation, back, drained_step);
      expect_derivative(state, sum(to, -0.6 * back, {1e-3, 2e-4, 0, 1e-3}));
    }
  }
}

TEST(drag, tangent_in_the_time_of_a_host_matches_central_differences) {
  State state(make_material(in_time(describe(reference_packing(), rough_law()))));
  for (const double step : {1.0, 0.1, 4.0}) {
    SCOPED_TRACE(step);
    state.set_time_step(step);
    lead(state, 2);
    expect_derivative(state, next_of(state));
    expect_derivative(state, sum(state.committed().deformation, -0.1, drained_step));
  }
}

// Without a strain no time passes.
TEST(drag, a_hold_changes_nothing) {
  State state(make_material(with_drag(describe(reference_packing(), rough_law()))));
  lead(state, 3);
  const Tensor before = state.committed().stress;
  const Evaluation held = evaluate(state, state.committed().deformation);
  EXPECT_LT(relative_difference(held.stress, before), 1e-9);
  EXPECT_GT(held.report.unbalanced, 1e-3);
}

TEST(drag, fades_in_a_hold_in_the_time_of_a_host) {
  State state(make_material(in_time(describe(small_packing(), rough_law()))));
  state.set_time_step(1);
  lead(state, 4);
  double last = evaluate(state, state.committed().deformation).report.unbalanced;
  EXPECT_GT(last, 1e-3);
  for (const double step : {10.0, 30.0, 100.0, 1000.0}) {
    state.set_time_step(step);
    last = evaluate(state, state.committed().deformation).report.unbalanced;
    state.commit();
  }
  EXPECT_LT(last, 1e-6);
  const Tensor held = state.committed().stress;
  State balanced(make_material(describe(small_packing(), rough_law())));
  Configuration there = state.committed();
  there.velocity.clear();
  balanced.restore(there);
  EXPECT_LT(relative_difference(evaluate(balanced, there.deformation).stress, held), 1e-5);
}

TEST(drag, any_time_step_is_solved) {
  const auto material = make_material(in_time(describe(small_packing(), rough_law())));
  State start(material);
  start.set_time_step(1);
  lead(start, 3);
  for (const double step : {1e-300, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12}) {
    for (const double share : {0.0, 1e-9, 1e-4, 1.0, -1.0, 5.0}) {
      SCOPED_TRACE(std::to_string(step) + ", " + std::to_string(share));
      State state(start);
      state.set_time_step(step);
      const Evaluation at =
          evaluate(state, sum(start.committed().deformation, share, drained_step));
      EXPECT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    }
  }
}

// The step leaves the answer, and faster than in proportion while no contact slips or opens anew.
TEST(drag, has_a_limit_in_the_step) {
  const auto material = make_material(with_drag(describe(reference_packing(), rough_law())));
  const auto led = [&](int steps) {
    State state(material);
    Tensor F = identity;
    for (int n = 0; n < steps; ++n) {
      F = sum(F, 4.0 / steps, drained_step);
      evaluate(state, F);
      state.commit();
    }
    return state.committed().stress;
  };
  const Tensor limit = led(64);
  const double coarse = relative_difference(led(4), limit);
  const double fine = relative_difference(led(16), limit);
  EXPECT_GT(coarse, 1e-5);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(fine, 0.35 * coarse);
}

// Springs take at once what masses cannot follow: a short increment is nearly as stiff as without
// drag, forwards and back.
TEST(drag, hardly_stiffens_a_short_increment) {
  const auto stiffness = [](bool dragged, double strain) {
    MaterialDescription description = describe(reference_packing(), rough_law());
    State state(make_material(dragged ? with_drag(description) : description));
    lead(state, 5);
    const Tensor from = state.committed().stress;
    const Tensor to =
        evaluate(state, sum(state.committed().deformation, strain, drained_step)).stress;
    return sum(to, -1, from)[3] / strain;
  };
  for (const double strain : {-0.5, -0.1, -1e-2}) {
    EXPECT_NEAR(stiffness(true, strain) / stiffness(false, strain), 1, 0.05) << strain;
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

TEST(drag, fades_with_its_number) {
  const Tensor F = sum(identity, 1, drained_step);
  State balanced(make_material(describe(small_packing(), rough_law())));
  const Tensor equilibrium = evaluate(balanced, F).stress;
  double last = 1, last_unbalanced = 1;
  for (const double number : {1e-3, 3e-4, 1e-4, 2e-5}) {
    State state(make_material(with_drag(describe(small_packing(), rough_law()), number)));
    const Evaluation found = evaluate(state, F);
    const double difference = relative_difference(found.stress, equilibrium);
    EXPECT_LT(difference, 0.7 * last) << number;
    EXPECT_LT(found.report.unbalanced, 0.5 * last_unbalanced) << number;
    last = difference;
    last_unbalanced = found.report.unbalanced;
  }
  EXPECT_LT(last, 1e-6);
  State least(make_material(with_drag(describe(small_packing(), rough_law()), 1e-300)));
  EXPECT_LT(relative_difference(evaluate(least, F).stress, equilibrium), 1e-6);
}

// Parts are steps of the same law: what they end in differs by the strain rate's mean alone.
TEST(drag, parts_of_an_increment_are_steps) {
  MaterialDescription description = with_drag(describe(small_packing(), rough_law()));
  State steps(make_material(description)), whole(make_material(description));
  description.solver.viscosity.steps = 4;
  State parts(make_material(description));
  constexpr Tensor stretch{1e-3, 0, 0, -3e-3};
  const Tensor F = sum(identity, 1, stretch);
  for (const double share : {0.25, 0.5, 0.75}) {
    evaluate(steps, sum(identity, share, stretch));
    steps.commit();
  }
  const Tensor in_steps = evaluate(steps, F).stress;
  const double off = relative_difference(in_steps, evaluate(whole, F).stress);
  EXPECT_GT(off, 3e-5);
  EXPECT_LT(relative_difference(in_steps, evaluate(parts, F).stress), 0.5 * off);
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

}  // namespace
}  // namespace grainlaw::core::test

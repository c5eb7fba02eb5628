// The exact tangent is the derivative of the stress: against central differences, where no contact
// changes status within the stencil.
#include "support.hpp"

#include <limits>
#include <optional>

namespace grainlaw::test {
namespace {

constexpr double bar = 1e-6;  // relative Frobenius error

// Central differences by all four components of F; none when a contact changes status on the way.
std::optional<Tangent> central_differences(State& state, const Tensor& F, double step) {
  EXPECT_EQ(evaluate(state, F).status, GRAINLAW_OK);
  const auto centre = bearing_contacts(state);
  Tangent result{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (const double side : {1.0, -1.0}) {
      Tensor moved = F;
      moved[k] += side * step;
      const Evaluation at = evaluate(state, moved);
      EXPECT_EQ(at.status, GRAINLAW_OK);
      if (bearing_contacts(state) != centre) return std::nullopt;
      for (std::size_t m = 0; m < 4; ++m) {
        result[m * 4 + k] += side * at.stress[m] / (2 * step);
      }
    }
  }
  return result;
}

// Differences err too: by the curvature of P over a wide stencil, or a change of status in a
// sub-increment on the way; by the solver's tolerance over a narrow one. A tangent that is wrong
// agrees with none of them.
void expect_derivative(State& state, const Tensor& F) {
  const Evaluation at = evaluate(state, F, TangentKind::exact);
  ASSERT_EQ(at.status, GRAINLAW_OK);
  EXPECT_EQ(at.report.tangent_exact, 1);
  double least = std::numeric_limits<double>::infinity();
  for (const double step : {1e-6, 3e-7, 1e-7, 3e-8}) {
    const auto differences = central_differences(state, F, step);
    if (differences) least = std::min(least, relative_difference(at.tangent, *differences));
    if (least <= bar) break;
  }
  EXPECT_LE(least, bar) << "infinite when a contact changes status in every stencil";
}

struct Path {
  const char* name;
  Tensor reached;  // committed, in steps
  int steps;
  Tensor next;  // where the tangent is taken
};

const Path paths[] = {
    {"start", identity, 1, {1.0002, 1e-4, -1e-4, 0.9996}},
    {"compressed", {1.002, 0, 0, 0.996}, 4, {1.0025, 2e-4, -1e-4, 0.995}},
    {"sheared", {1, 0.004, 0.001, 0.999}, 5, {1.0001, 0.005, 0.0011, 0.9987}},
};

void expect_derivative_along(const MaterialDescription& description) {
  const auto material = make_material(description);
  for (const Path& path : paths) {
    SCOPED_TRACE(path.name);
    State state(material);
    advance(state, path.reached, path.steps);
    expect_derivative(state, path.next);
    expect_derivative(state, product(rotation(0.7), path.next));
  }
}

TEST(tangent, of_the_periodic_cell_matches_central_differences) {
  expect_derivative_along(describe(small_packing(), rough_law()));
}

TEST(tangent, of_a_frame_matches_central_differences) {
  expect_derivative_along(describe(small_packing(), rough_law(), BoundaryType::frame_p));
}

TEST(tangent, with_locked_rotation_matches_central_differences) {
  expect_derivative_along(describe(small_packing(), locked_law()));
}

TEST(tangent, without_friction_matches_central_differences) {
  // Small packings may not hold without it, or change their contacts within every stencil.
  expect_derivative_along(describe(reference_packing(), smooth_law()));
}

TEST(tangent, of_the_reference_packing_matches_central_differences) {
  expect_derivative_along(describe(reference_packing(), rough_law()));
}

TEST(tangent, through_sub_increments_matches_central_differences) {
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    MaterialDescription description = describe(small_packing(), rough_law(), boundary);
    description.solver.increment_limit = 0.05;
    State state(make_material(description));
    EXPECT_GE(evaluate(state, paths[0].next).report.subincrements, 3);
    expect_derivative_along(description);
  }
}

// A rattler left by one sub-increment may come to bear in the next, from a place that no
// equilibrium determines; then the tangent does not claim to be exact.
TEST(tangent, through_sub_increments_is_exact_where_it_says_so) {
  int exact = 0;
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    MaterialDescription description = describe(reference_packing(), rough_law(), boundary);
    description.solver.increment_limit = 0.05;
    const auto material = make_material(description);
    for (const Path& path : paths) {
      SCOPED_TRACE(path.name);
      State state(material);
      advance(state, path.reached, path.steps);
      const Evaluation at = evaluate(state, path.next, TangentKind::exact);
      EXPECT_GE(at.report.subincrements, 3);
      if (at.report.tangent_exact == 0) continue;
      ++exact;
      expect_derivative(state, path.next);
    }
  }
  EXPECT_GE(exact, 3);
}

TEST(tangent, turns_the_stress_under_a_spin) {
  constexpr Tensor spin{0, -1, 1, 0};
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    const auto material = make_material(describe(small_packing(), rough_law(), boundary));
    for (const Path& path : paths) {
      State state(material);
      advance(state, path.reached, path.steps);
      for (const double angle : {0.0, 0.7, 3.0}) {
        const Tensor F = product(rotation(angle), path.next);
        const Evaluation at = evaluate(state, F, TangentKind::exact);
        ASSERT_EQ(at.status, GRAINLAW_OK);
        const Tensor change = product(spin, F);
        Tensor by_tangent{};
        for (std::size_t m = 0; m < 4; ++m) {
          for (std::size_t k = 0; k < 4; ++k) by_tangent[m] += at.tangent[m * 4 + k] * change[k];
        }
        EXPECT_LE(relative_difference(by_tangent, product(spin, at.stress)), 1e-9) << path.name;
      }
    }
  }
}

TEST(tangent, by_forward_differences_is_near_the_exact_one) {
  State state(make_material(describe(reference_packing(), rough_law())));
  advance(state, paths[1].reached, paths[1].steps);
  const Evaluation exact = evaluate(state, paths[1].next, TangentKind::exact);
  const Evaluation perturbed = evaluate(state, paths[1].next, TangentKind::perturbed);
  ASSERT_EQ(perturbed.status, GRAINLAW_OK);
  EXPECT_EQ(perturbed.report.tangent_exact, 0);
  EXPECT_EQ(perturbed.stress, exact.stress);
  EXPECT_LE(relative_difference(perturbed.tangent, exact.tangent), 0.01);
}

}  // namespace
}  // namespace grainlaw::test

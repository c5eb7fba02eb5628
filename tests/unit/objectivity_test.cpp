// A rotation changes nothing in the packing: the stress turns with it.
#include "firm_packing.hpp"
#include "support.hpp"

#include <numbers>

namespace grainlaw::core::test {
namespace {

constexpr double bar = 1e-10;
constexpr double angles[] = {0.01, 0.7, -1.5, 2.5, std::numbers::pi};
const Tensor increments[] = {{1.0005, 2e-4, -1e-4, 0.999}, {1, 0.002, 0, 1}, {0.999, 0, 0, 0.999}};

std::vector<MaterialDescription> descriptions() {
  static const Packing packing = firm_packing();
  return {describe(packing, rough_law()), describe(packing, rough_law(), BoundaryType::frame_p),
          describe(packing, locked_law()), describe(packing, smooth_law())};
}

// sigma12 - sigma21, relative.
double asymmetry(const Tensor& stress, const Tensor& F) {
  const Tensor kirchhoff = product(stress, transpose(F));
  return std::abs(kirchhoff[1] - kirchhoff[2]) / norm(kirchhoff);
}

TEST(objectivity, stress_turns_with_the_rotation) {
  for (const auto& description : descriptions()) {
    State state(make_material(description));
    for (const Tensor& F : increments) {
      const Evaluation still = evaluate(state, F);
      ASSERT_EQ(still.status, GRAINLAW_OK);
      for (const double angle : angles) {
        const Tensor Q = rotation(angle);
        const Evaluation turned = evaluate(state, product(Q, F));
        ASSERT_EQ(turned.status, GRAINLAW_OK);
        EXPECT_LE(relative_difference(turned.stress, product(Q, still.stress)), bar);
      }
    }
  }
}

TEST(objectivity, holds_for_the_history_after_a_rotated_increment) {
  for (const auto& description : descriptions()) {
    const auto material = make_material(description);
    for (const double angle : angles) {
      State still(material);
      State turned(material);
      const Tensor Q = rotation(angle);
      const Tensor Q2 = rotation(-0.3 * angle);
      const Tensor first = increments[0];
      const Tensor second = product(increments[1], first);
      const Tensor third = product(increments[2], second);
      advance(still, first);
      advance(turned, product(Q, first));
      EXPECT_EQ(sliding_contacts(turned.committed()), sliding_contacts(still.committed()));
      const Evaluation a = advance(still, second);
      const Evaluation b = advance(turned, product(Q2, second));
      EXPECT_LE(relative_difference(b.stress, product(Q2, a.stress)), bar);
      const Evaluation c = advance(still, third);
      const Evaluation d = advance(turned, product(Q, third));
      EXPECT_LE(relative_difference(d.stress, product(Q, c.stress)), bar);
      EXPECT_NEAR(turned.committed().dissipated, still.committed().dissipated,
                  1e-8 * still.committed().dissipated);
    }
  }
}

// Rounding decides where a disc without contacts is left, and the stress once it bears again.
TEST(objectivity, holds_along_a_path_until_a_report_counts_rattlers_that_bear_again) {
  int parted = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    auto description = describe(small_packing(100, seed), rough_law());
    description.solver.tolerance = 1e-11;
    const auto material = make_material(description);
    State still(material);
    State turned(material);
    bool counted = false;
    for (int k = 1; k <= 20 && !counted; ++k) {
      const double strain = 1e-3 * k;
      const Tensor F{1 + 0.4 * strain, 0.1 * strain, 0, 1 - strain};
      const Tensor Q = rotation(0.3 + 0.05 * k);
      const Evaluation a = advance(still, F);
      const Evaluation b = advance(turned, product(Q, F));
      counted = a.report.rattlers_loaded > 0;
      EXPECT_EQ(a.report.rattlers_loaded, b.report.rattlers_loaded) << seed << ' ' << k;
      if (!counted) {
        EXPECT_LE(relative_difference(b.stress, product(Q, a.stress)), 1e-9) << seed << ' ' << k;
      }
    }
    parted += counted ? 1 : 0;
  }
  EXPECT_GE(parted, 1);
}

TEST(objectivity, pure_rotation_turns_the_initial_stress) {
  // Every increment may leave a tolerance's worth of residual; here it is solved to rounding.
  constexpr double to_rounding = 1e-13;
  for (auto description : descriptions()) {
    description.solver.tolerance = to_rounding;
    const auto material = make_material(description);
    const auto& s = material->initial.stress;
    const Tensor initial{s[0], s[1], s[2], s[3]};
    State state(material);
    const auto contacts = bearing_contacts(state);
    for (const double angle : angles) {
      const Tensor Q = rotation(angle);
      const Evaluation turned = advance(state, Q);
      EXPECT_LE(relative_difference(turned.stress, product(Q, initial)), bar);
      EXPECT_EQ(bearing_contacts(state), contacts);
      EXPECT_LE(state.committed().dissipated, 1e-15);
    }
  }
}

TEST(objectivity, cauchy_stress_is_symmetric_at_equilibrium) {
  // A moment left on a particle is asymmetry: at most a tolerance's worth of R per contact.
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    for (auto description : descriptions()) {
      description.solver.tolerance = tolerance;
      const auto material = make_material(description);
      if (!material->law.rotating() && material->law.tangential()) continue;  // moments are held
      State state(material);
      for (const Tensor& F : increments) {
        const Tensor turned = product(rotation(0.4), F);
        const Evaluation at = evaluate(state, turned);
        ASSERT_EQ(at.status, GRAINLAW_OK);
        EXPECT_LE(asymmetry(at.stress, turned), tolerance);
      }
    }
  }
}

TEST(objectivity, locked_particles_hold_moments) {
  State state(make_material(describe(reference_packing(), locked_law())));
  const Evaluation at = evaluate(state, increments[1]);
  ASSERT_EQ(at.status, GRAINLAW_OK);
  EXPECT_GT(asymmetry(at.stress, increments[1]), 1e-3);
}

}  // namespace
}  // namespace grainlaw::core::test

// Spheres in the hypothesis Tridimensional, with drag: a drained test, and a step that the host cuts.
#include "mgis_host.hpp"

#include <grainlaw/grainlaw.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainlaw::test {
namespace {

using Matrix = std::array<double, 9>;

class mgis_spheres : public testing::Test {
 protected:
  BehaviourLibrary library{std::string(GRAINLAW_BEHAVIOURS) + "/libSpheresInTime.so"};
  Manager host{library, "SpheresInTime", "Tridimensional", 1, first_piola, dP_dF};
  const grainlaw::Material material =
      grainlaw::Material::load(std::string(GRAINLAW_BEHAVIOURS) + "/../spheres_in_time.toml");
};

// The lateral stretches by Newton's method; what the host is given, the library gives.
TEST_F(mgis_spheres, drained_test_has_the_bits_of_the_library) {
  constexpr double pressure = 100e3;
  grainlaw::State state(material);
  state.set_time_step(1);
  Matrix F{1, 0, 0, 0, 1, 0, 0, 0, 1}, P{};
  std::array<double, 81> A{};
  double axial = 0;
  for (int step = 0; step <= 5; ++step) {
    F[8] = 1 - 2e-3 * step;
    double residual = 1;
    for (int iteration = 0; residual > 1e-9 && iteration < 8; ++iteration) {
      host.set_F_in_space(0, F);
      ASSERT_EQ(host.integrate(0), 1) << host.message;
      ASSERT_TRUE(state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A));
      for (std::size_t k = 0; k < 9; ++k) {
        EXPECT_EQ(host.s1.forces[k], P[tensor_order[k]]);
        for (std::size_t l = 0; l < 9; ++l)
          EXPECT_EQ(host.K[9 * k + l], A[9 * tensor_order[k] + tensor_order[l]]);
      }
      const double r1 = host.s1.forces[0] + pressure, r2 = host.s1.forces[1] + pressure;
      const double a = host.K[0], b = host.K[1], c = host.K[9], d = host.K[10];
      residual = std::hypot(r1, r2) / pressure;
      F[0] -= (d * r1 - b * r2) / (a * d - b * c);
      F[4] -= (a * r2 - c * r1) / (a * d - b * c);
    }
    EXPECT_LE(residual, 1e-9);
    EXPECT_LT(host.s1.forces[2], axial);
    axial = host.s1.forces[2];
    F = {host.s1.gradients[0], 0, 0, 0, host.s1.gradients[1], 0, 0, 0, host.s1.gradients[2]};
    host.update();
    state.commit();
  }
}

TEST_F(mgis_spheres, a_step_that_was_cut_ends_like_the_same_steps_uncut) {
  constexpr double target = 0.4;  // shortening; more than the library takes at once
  struct Step {
    double shortening, time;
  };
  std::vector<Step> steps;
  int cuts = 0;
  for (double shortening = 0, step = target; shortening < target - 1e-9;) {
    const double next = std::min(shortening + step, target);
    host.set_F_in_space(0, Matrix{1, 1e-3 * next, 0, 0, 1, 0, 0, 0, 1 - next});
    host.dt = step / target;
    if (host.integrate(0, no_tangent) < 0) {
      ASSERT_LT(host.rdt, 1) << host.message;
      step *= host.rdt;
      host.revert();
      ASSERT_LT(++cuts, 10);
      continue;
    }
    steps.push_back({shortening = next, host.dt});
    host.update();
  }
  EXPECT_GE(cuts, 1);
  grainlaw::State uncut(material);
  Matrix P{};
  for (const auto& [shortening, time] : steps) {
    uncut.set_time_step(time);
    ASSERT_TRUE(uncut.evaluate(Matrix{1, 1e-3 * shortening, 0, 0, 1, 0, 0, 0, 1 - shortening}, P));
    uncut.commit();
  }
  for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(host.s0.forces[k], P[tensor_order[k]]);
}

TEST_F(mgis_spheres, need_the_hypothesis_in_space) {
  Manager plane(library, "SpheresInTime", "PlaneStrain", 1, first_piola, dP_dF);
  EXPECT_EQ(plane.integrate(0), -1);
  EXPECT_STREQ(plane.message.c_str(),
               "SpheresInTime: a packing of spheres needs the hypothesis Tridimensional");
}

}  // namespace
}  // namespace grainlaw::test

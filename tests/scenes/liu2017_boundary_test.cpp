// The figures of Liu, Bosco & Suiker (2017) in small, through the C ABI: what the scenes in
// verification/scenes/liu2017_boundary show at full size.

#include <grainlaw/grainlaw.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace grainlaw::test {
namespace {

using grainlaw::Material;
using grainlaw::State;
using Tensor = std::array<double, 4>;

const std::string square = R"(
dimension = 2
thickness = 1e-3
contact = { law = "frictional", kn = 1e4, ratio = 0.2, friction = 0.4 }
solver = { tolerance = 1e-8 }

[packing]
generator = "square"
columns = 4
rows = 4
radius = 1.02e-3
overlap = 0.04e-3
radius_spread = 1e-3
seed = 1
)";

std::string irregular(int count, const std::string& contact = "") {
  return R"(
dimension = 2
thickness = 1e-3
packing = { generator = "lubachevsky-stillinger", count = )" +
         std::to_string(count) + R"(, radii = [0.67e-3, 1.34e-3], seed = 1, pressure = 100e3 }
solver = { tolerance = 1e-6 }
[contact]
law = "frictional"
kn = 1e4
ratio = 0.2
friction = 0.4
)" + contact;
}

std::string boundary(const char* type, const char* method = "direct") {
  return std::string("\n[boundary]\ntype = \"") + type + "\"\nmethod = \"" + method + "\"\n";
}

double norm(const Tensor& tensor) {
  double sum = 0;
  for (const double value : tensor) sum += value * value;
  return std::sqrt(sum);
}

// P after each of the steps on the straight way from I to F, as far as it goes.
std::vector<Tensor> stress_along(const std::string& text, const Tensor& F, int steps) {
  const Material material = Material::parse(text, ".");
  State state(material);
  std::vector<Tensor> stress;
  for (int k = 1; k <= steps; ++k) {
    const double s = static_cast<double>(k) / steps;
    const Tensor at{1 + s * (F[0] - 1), s * F[1], s * F[2], 1 + s * (F[3] - 1)};
    Tensor P{};
    if (!state.evaluate(at, P)) break;
    state.commit();
    stress.push_back(P);
  }
  return stress;
}

// Up to where the lattice buckles; beyond, each boundary condition follows a branch of its own.
constexpr Tensor compression_shear{0.998, -0.02, -0.02, 0.998};
constexpr Tensor shear{1, 0.05, 0, 1};

void expect_not_below(const std::vector<Tensor>& stiff, const std::vector<Tensor>& soft) {
  ASSERT_FALSE(stiff.empty());
  ASSERT_FALSE(soft.empty());
  for (std::size_t k = 0; k < std::min(stiff.size(), soft.size()); ++k)
    EXPECT_GE(norm(stiff[k]), norm(soft[k]) * (1 - 1e-6)) << "step " << k + 1;
}

TEST(liu2017_boundary, stress_of_regular_discs_falls_from_d_over_p_to_t) {  // fig. 4
  const auto d = stress_along(square + boundary("frame-d"), compression_shear, 10);
  const auto p = stress_along(square + boundary("frame-p"), compression_shear, 10);
  const auto t = stress_along(square + boundary("frame-t"), compression_shear, 10);
  EXPECT_EQ(d.size(), 10u);
  EXPECT_EQ(p.size(), 10u);
  expect_not_below(d, p);
  expect_not_below(p, t);
}

TEST(liu2017_boundary, stress_of_irregular_discs_falls_from_d_to_p) {  // fig. 7
  const auto d = stress_along(irregular(25) + boundary("frame-d"), shear, 10);
  const auto p = stress_along(irregular(25) + boundary("frame-p"), shear, 10);
  EXPECT_EQ(d.size(), 10u);
  expect_not_below(d, p);
}

TEST(liu2017_boundary, layer_keeps_its_vertical_stress_and_resists_shear) {  // fig. 11
  const std::string layer = R"(
[boundary]
type = "mixed"
left = { x = "P", y = "P" }
right = { x = "P", y = "P" }
bottom = { x = "D", y = "D", row = "rigid" }
top = { x = "D", y = "T", row = "rigid" }
stress = { P22 = -100e3 }
)";
  const auto stress = stress_along(irregular(100) + layer, shear, 20);
  ASSERT_EQ(stress.size(), 20u);
  double peak = 0;
  for (const Tensor& P : stress) {
    EXPECT_NEAR(P[3], -100e3, 1e-3 * 100e3);
    peak = std::max(peak, P[1] / -P[3]);
  }
  EXPECT_GT(peak, 0.2);
  EXPECT_LT(peak, 0.6);
}

TEST(liu2017_boundary, uniform_stress_ends_in_its_own_status) {  // how far T carries
  const Material material = Material::parse(irregular(100) + boundary("frame-t"), ".");
  State state(material);
  grainlaw_status last = GRAINLAW_OK;
  for (int k = 1; k <= 100 && last == GRAINLAW_OK; ++k) {
    Tensor P{};
    last = state.evaluate(Tensor{1, 0.005 * k, 0, 1}, P).status;
    if (last == GRAINLAW_OK) state.commit();
  }
  EXPECT_EQ(last, GRAINLAW_COLLAPSED);
}

TEST(liu2017_boundary, locked_rotation_makes_stronger) {  // liu2019_biaxial, fig. 10
  const Tensor compression{1.04, 0, 0, 0.96};
  const auto free = stress_along(irregular(100) + boundary("periodic-cell"), compression, 20);
  const auto locked = stress_along(irregular(100, "rotation = false\n") + boundary("periodic-cell"),
                                   compression, 20);
  ASSERT_EQ(free.size(), 20u);
  ASSERT_EQ(locked.size(), 20u);
  const auto deviator = [](const std::vector<Tensor>& P) { return P.back()[0] - P.back()[3]; };
  EXPECT_GT(deviator(locked), 1.3 * deviator(free));
}

}  // namespace
}  // namespace grainlaw::test

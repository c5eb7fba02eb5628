// Very stiff grains in increments far longer than their overlaps.
#include "support.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace grainlaw::test {
namespace {

// 60 discs of Hertz, whose overlaps are 3e-6 of a radius at 100 kPa.
const char* const stiff = R"(
dimension = 2
thickness = 0.02
packing = { generator = "compaction", count = 60, radii = [2e-3, 4e-3], seed = 1, pressure = 1e5, friction = 0.2 }
contact = { law = "hertz", shear_modulus = 2.1773e14, poisson = 0.2, friction = 0.5 }
solver = { contacts_lost = "stress_free" }
)";

TEST(stiff_increment, does_not_push_particles_through_one_another) {
  constexpr double strain = 1e-4;
  const Material material = Material::parse(stiff, ".");
  State state(material);
  const std::vector<double> F{1 / (1 - strain), 0, 0, 1 - strain};
  std::vector<double> P(4);
  grainlaw_report report = grainlaw_report_default();
  const auto status = grainlaw_evaluate(state.get(), F.data(), 0, P.data(), nullptr, &report);
  if (status != GRAINLAW_OK) {
    EXPECT_EQ(status, GRAINLAW_NOT_CONVERGED);
    EXPECT_LT(report.step_ratio, 1);
    return;
  }
  // An affine change of all overlaps by the strain would store this much [J].
  const double modulus = 2.1773e14 / 0.8, overlap = 2 * 4e-3 * (strain + 1e-5);
  const double most = 3 * 60 * modulus * std::sqrt(2e-3) * std::pow(overlap, 2.5);
  double stored = 0;
  std::size_t one = 1;
  const auto measured = grainlaw_state_measure(state.get(), GRAINLAW_ELASTIC_ENERGY, &stored, &one);
  ASSERT_EQ(measured, GRAINLAW_OK);
  EXPECT_LT(stored, most) << "P22 " << P[3] << " Pa";
}

}  // namespace
}  // namespace grainlaw::test

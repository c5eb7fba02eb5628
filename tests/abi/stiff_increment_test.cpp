// Very stiff grains in increments far longer than their overlaps.
#include "support.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace grainlaw::test {
namespace {

// 60 discs of Hertz under 100 kPa.
std::string stiff(double shear_modulus, const std::string& boundary, double viscous_number) {
  return R"(
dimension = 2
thickness = 0.02
packing = { generator = "compaction", count = 60, radii = [2e-3, 4e-3], seed = 1, pressure = 1e5, friction = 0.2 }
contact = { law = "hertz", poisson = 0.2, friction = 0.5, shear_modulus = )" +
         std::to_string(shear_modulus) + R"( }
boundary = { type = ")" +
         boundary + R"(" }
solver = { contacts_lost = "stress_free", viscous_number = )" +
         std::to_string(viscous_number) + " }\n";
}

// At this stiffness overlaps are 3e-6 of a radius.
TEST(stiff_increment, does_not_push_particles_through_one_another) {
  constexpr double strain = 1e-4, shear_modulus = 2.1773e14;
  const Material material = Material::parse(stiff(shear_modulus, "periodic-cell", 0), ".");
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
  const double modulus = shear_modulus / 0.8, overlap = 2 * 4e-3 * (strain + 1e-5);
  const double most = 3 * 60 * modulus * std::sqrt(2e-3) * std::pow(overlap, 2.5);
  double stored = 0;
  std::size_t one = 1;
  const auto measured = grainlaw_state_measure(state.get(), GRAINLAW_ELASTIC_ENERGY, &stored, &one);
  ASSERT_EQ(measured, GRAINLAW_OK);
  EXPECT_LT(stored, most) << "P22 " << P[3] << " Pa";
}

// Grains a tenth as stiff end this path at 0.4 MPa, these in increments a fifth as long at 3.4 MPa.
TEST(stiff_increment, loses_no_stress_in_a_frame_with_drag) {
  const Material material = Material::parse(stiff(217732421580.72693, "frame-p", 1e-3), ".");
  State state(material);
  std::vector<double> P(4);
  for (int k = 1; k <= 20; ++k) {
    const double strain = 1e-3 * k;
    const std::vector<double> F{1 / (1 - strain), 0, 0, 1 - strain};
    grainlaw_report report = grainlaw_report_default();
    const auto status = grainlaw_evaluate(state.get(), F.data(), 0, P.data(), nullptr, &report);
    ASSERT_EQ(status, GRAINLAW_OK) << k;
    ASSERT_EQ(grainlaw_commit(state.get()), GRAINLAW_OK);
  }
  EXPECT_LT(P[3], -1e5);
  EXPECT_GT(P[3], -1e8);
}

double measured(const State& state, grainlaw_measure quantity) {
  double value = 0;
  std::size_t one = 1;
  EXPECT_EQ(grainlaw_state_measure(state.get(), quantity, &value, &one), GRAINLAW_OK);
  return value;
}

// Work of the stress at the end of each increment, and on the drag [J].
struct Work {
  double stress = 0, drag = 0;
};

// Evaluates in halves what is refused, and commits.
void compress(State& state, double from, double to, int cuts, Work& work) {
  const std::vector<double> F{1 / (1 - to), 0, 0, 1 - to};
  std::vector<double> P(4);
  grainlaw_report report = grainlaw_report_default();
  if (grainlaw_evaluate(state.get(), F.data(), 0, P.data(), nullptr, &report) == GRAINLAW_OK) {
    ASSERT_EQ(grainlaw_commit(state.get()), GRAINLAW_OK);
    const double stretch = 1 / (1 - to) - 1 / (1 - from);
    work.stress +=
        measured(state, GRAINLAW_REFERENCE_VOLUME) * (P[0] * stretch - P[3] * (to - from));
    work.drag += report.viscous_work;
    return;
  }
  ASSERT_GT(cuts, 0) << "refused at " << to;
  const double between = 0.5 * (from + to);
  compress(state, from, between, cuts - 1, work);
  compress(state, between, to, cuts - 1, work);
}

// Which way the packing takes depends on rounding, and with it the stress. On every way springs that
// stiffen store at most what the stress at the end of an increment does.
TEST(stiff_increment, loses_no_more_than_the_work_in_a_frame_with_drag) {
  const Material material = Material::parse(stiff(217732421580726.94, "frame-p", 1e-3), ".");
  State state(material);
  Work work;
  const double stored_before = measured(state, GRAINLAW_ELASTIC_ENERGY);
  for (int k = 0; k < 20; ++k) compress(state, 1e-3 * k, 1e-3 * (k + 1), 6, work);
  const double stored = measured(state, GRAINLAW_ELASTIC_ENERGY) - stored_before;
  const double lost = work.drag + measured(state, GRAINLAW_DISSIPATED_ENERGY);
  EXPECT_LT(stored + lost, work.stress);
  EXPECT_GT(work.drag, 0);
}

}  // namespace
}  // namespace grainlaw::test

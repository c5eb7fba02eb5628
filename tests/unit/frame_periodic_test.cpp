// A frame that is cut from a periodic packing, its contacts weighted by their copies, is that
// packing.
#include "support.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double tolerance = 1e-11;

MaterialDescription framed(const Packing& packing, const ContactLaw& law, ContactWeight weight) {
  MaterialDescription description = describe(packing, law, BoundaryType::frame_p, tolerance);
  description.boundary.weight = weight;
  return description;
}

Tensor stress_of(const State& state) {
  const auto& p = state.current().stress;
  return {p[0], p[1], p[2], p[3]};
}

TEST(frame_periodic, stress_is_that_of_the_cell_along_a_path) {
  const Packing packing = without_rattlers(reference_packing());
  EXPECT_EQ(packing.size(), 388);
  for (const auto& law : {rough_law(), locked_law(), smooth_law()}) {
    State cell(make_material(describe(packing, law, BoundaryType::periodic_cell, tolerance)));
    State frame(make_material(framed(packing, law, ContactWeight::copies)));
    EXPECT_LE(relative_difference(stress_of(frame), stress_of(cell)), 1e-10);
    for (int step = 1; step <= 3; ++step) {
      const double strain = 1e-3 * step;
      const Tensor F{1 + 0.3 * strain, 0.5 * strain, 0, 1 - strain};
      const Evaluation in_cell = advance(cell, F);
      const Evaluation in_frame = advance(frame, F);
      EXPECT_LE(relative_difference(in_frame.stress, in_cell.stress), 1e-10) << step;
    }
    if (law.tangential()) {
      EXPECT_GT(sliding_contacts(cell.committed()), 50);
    }
  }
}

TEST(frame_periodic, takes_the_relaxation_steps_of_the_cell) {
  const Packing packing = without_rattlers(reference_packing());
  State cell(make_material(describe(packing, rough_law(), BoundaryType::periodic_cell, tolerance)));
  State frame(make_material(framed(packing, rough_law(), ContactWeight::copies)));
  double in_cell = 0;
  double in_frame = 0;
  for (int step = 1; step <= 5; ++step) {
    const Tensor F{1 + 3e-4 * step, 0, 0, 1 - 1e-3 * step};
    in_cell += static_cast<double>(advance(cell, F).report.relaxation_steps);
    in_frame += static_cast<double>(advance(frame, F).report.relaxation_steps);
  }
  EXPECT_LE(in_frame, 1.2 * in_cell);
}

TEST(frame_periodic, measures_are_those_of_the_cell) {
  State cell(make_material(
      describe(reference_packing(), rough_law(), BoundaryType::periodic_cell, tolerance)));
  State frame(make_material(framed(reference_packing(), rough_law(), ContactWeight::copies)));
  for (const auto what : {GRAINLAW_VOLUME, GRAINLAW_VOID_RATIO, GRAINLAW_COORDINATION,
                          GRAINLAW_COORDINATION_NO_RATTLERS, GRAINLAW_ANISOTROPY,
                          GRAINLAW_FABRIC_INTENSITY, GRAINLAW_MEAN_OVERLAP, GRAINLAW_ELASTIC_ENERGY,
                          GRAINLAW_CONTACTS, GRAINLAW_PARTICLES, GRAINLAW_REFERENCE_VOLUME}) {
    const double expected = measure(cell, what);
    EXPECT_NEAR(measure(frame, what), expected, 1e-9 * std::abs(expected)) << what;
  }
  const Tensor F{1.0003, 0, 0, 0.999};
  advance(cell, F);
  advance(frame, F);
  // A contact of a rattler that carries nothing may or may not count.
  for (const auto what : {GRAINLAW_VOLUME, GRAINLAW_VOID_RATIO, GRAINLAW_ELASTIC_ENERGY}) {
    const double expected = measure(cell, what);
    EXPECT_NEAR(measure(frame, what), expected, 1e-9 * std::abs(expected)) << what;
  }
}

TEST(frame_periodic, weight_one_starts_at_another_stress) {
  State cell(make_material(describe(reference_packing(), rough_law())));
  State frame(make_material(framed(reference_packing(), rough_law(), ContactWeight::one)));
  const double difference = relative_difference(stress_of(frame), stress_of(cell));
  // Contacts along a side count twice: 4.7 % here, more in a smaller packing.
  EXPECT_NEAR(difference, 0.047, 0.001);
  // The sides are stiffer, and stay so.
  const Tensor F{1.0003, 0, 0, 0.999};
  EXPECT_GT(relative_difference(advance(frame, F).stress, advance(cell, F).stress), 0.02);
}

TEST(frame_periodic, cell_after_a_frame_in_the_same_thread_is_the_cell) {
  const auto cell = make_material(describe(small_packing(), rough_law()));
  const auto frame = make_material(framed(small_packing(), rough_law(), ContactWeight::copies));
  const Tensor F{1.0003, 0, 0, 0.999};
  State before(cell);
  const Tensor expected = evaluate(before, F).stress;
  State between(frame);
  evaluate(between, F);
  State after(cell);
  EXPECT_EQ(evaluate(after, F).stress, expected);
}

}  // namespace
}  // namespace grainlaw::core::test

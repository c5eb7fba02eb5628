// Every contact law through a state: energy, objectivity, saving, files.
#include "../temporary_directory.hpp"
#include "law_support.hpp"

#include "state/output.hpp"
#include "state/serialise.hpp"

namespace grainlaw::core::test {
namespace {

// Work done on the packing over a cycle, less what is stored, dissipated and taken by drag. Shear;
// with locked rotation along fixed axes, as the couple that holds the discs does work when the frame
// turns.
struct Balance {
  double error = 0, dissipated = 0, dragged = 0, moved = 0, broken_bonds = 0;
};

Balance go_round(const std::shared_ptr<const Material>& material, int increments) {
  State state(material);
  const double volume = measure(state, GRAINLAW_REFERENCE_VOLUME);
  const double stored = measure(state, GRAINLAW_ELASTIC_ENERGY);
  const auto& p = state.current().stress;
  Tensor stress{p[0], p[1], p[2], p[3]};
  Tensor F = identity;
  Balance result;
  double sum_of_work = 0;
  const bool locked = !material->law.rotation;
  constexpr double usual_increments = 20;
  state.set_time_step(usual_increments / increments);
  // Bonds break in the larger cycle.
  const double amplitude = material->law.bonds() ? 8e-3 : 2e-3;
  for (int k = 1; k <= 2 * increments; ++k) {
    const double share = static_cast<double>(std::min(k, 2 * increments - k)) / increments;
    const double strain = amplitude * share;
    const Tensor next{1 + 0.2 * strain, locked ? 0 : strain, 0, 1 - 0.5 * strain};
    const Evaluation at = advance(state, next);
    const double work = 0.5 * volume * dot(sum(stress, 1, at.stress), sum(next, -1, F));
    sum_of_work += work;
    result.dragged += at.report.viscous_work;
    result.moved += std::abs(work);
    stress = at.stress;
    F = next;
    EXPECT_GE(state.committed().dissipated, result.dissipated - 1e-9 * result.moved);
    result.dissipated = state.committed().dissipated;
  }
  result.broken_bonds = measure(state, GRAINLAW_BROKEN_BONDS);
  result.error = sum_of_work - (measure(state, GRAINLAW_ELASTIC_ENERGY) - stored) -
                 result.dissipated - result.dragged;
  return result;
}

bool breaks(const ContactLaw& law) {
  return law.bonds() && law.rotation && law.bond.normal_strength < 1000;
}

TEST(law_state, energy_balances_over_a_cycle_to_first_order_of_the_increment) {
  for (const auto& [name, law] : composite_laws()) {
    double coarse = 0;
    double fine = 0;
    double moved = 0;
    for (const std::uint64_t seed : {1U, 2U}) {
      const auto material = make_material(describe_law(small_packing(80, seed), law));
      coarse += std::abs(go_round(material, 20).error);
      const Balance many = go_round(material, 100);
      fine += std::abs(many.error);
      moved += many.moved;
      EXPECT_EQ(many.broken_bonds > 0, breaks(law)) << name;
    }
    EXPECT_LT(coarse, 0.01 * moved) << name;
    EXPECT_LT(fine, 0.3 * coarse + 1e-6 * moved) << name;
  }
}

// What drag takes after a break counts as broken bonds too.
TEST(law_state, energy_balances_with_drag_to_first_order_of_the_increment) {
  for (const auto& [name, law] : composite_laws()) {
    if (breaks(law)) continue;
    double coarse = 0, fine = 0, moved = 0, dragged = 0;
    for (const std::uint64_t seed : {1U, 2U}) {
      MaterialDescription description = describe_law(small_packing(80, seed), law);
      description.solver.viscosity.number = 1e-3;
      const auto material = make_material(description);
      coarse += std::abs(go_round(material, 20).error);
      const Balance many = go_round(material, 100);
      fine += std::abs(many.error);
      moved += many.moved;
      dragged += many.dragged;
    }
    EXPECT_GT(dragged, 0) << name;
    EXPECT_LT(coarse, 0.01 * moved) << name;
    EXPECT_LT(fine, 0.3 * coarse + 1e-6 * moved) << name;
  }
}

TEST(law_state, stress_turns_with_the_packing) {
  for (const auto& [name, law] : composite_laws()) {
    const auto material = make_material(describe_law(small_packing(), law));
    const Tensor F{1.0004, 2e-3, -1e-4, 0.9985};
    State still(material);
    const Tensor P = advance(still, F).stress;
    for (const double angle : {0.3, 3.0}) {
      const Tensor Q = rotation(angle);
      State turned(material);
      EXPECT_LE(relative_difference(advance(turned, product(Q, F)).stress, product(Q, P)), 1e-8)
          << name;
    }
    const Tensor cauchy = product(P, transpose(F));
    if (law.rotating()) {
      EXPECT_NEAR(cauchy[1], cauchy[2], 1e-8 * norm(cauchy)) << name;
    }
  }
}

TEST(law_state, goes_on_from_saved_bytes_with_the_same_bits) {
  for (const auto& [name, law] : composite_laws()) {
    const auto material = make_material(describe_law(small_packing(), law));
    State state(material);
    advance(state, {1.001, 0.003, 0, 0.998}, 3);
    std::vector<std::byte> bytes(saved_size(*material, state.committed()));
    save_configuration(*material, state.committed(), bytes);
    State other(material);
    other.restore(load_configuration(*material, bytes));
    EXPECT_TRUE(same_bits(state.committed(), other.committed())) << name;
    EXPECT_EQ(state.committed().moments, other.committed().moments) << name;
    EXPECT_EQ(state.committed().broken_bonds, other.committed().broken_bonds) << name;
    const Tensor next{1.0012, 0.0035, 0, 0.9977};
    EXPECT_EQ(advance(state, next).stress, advance(other, next).stress) << name;
    EXPECT_TRUE(same_bits(state.committed(), other.committed())) << name;
  }
}

TEST(law_state, a_packing_written_starts_from_the_same_stress) {
  const TemporaryDirectory directory;
  const std::string prefix = directory / "packing";
  ContactLaw across_gaps = bonded_law(1);
  across_gaps.bond.gap = 1e-4;
  auto laws = composite_laws();
  laws.push_back({"bonds across gaps", across_gaps});
  for (const auto& [name, law] : laws) {
    const auto material = make_material(describe_law(small_packing(), law));
    State state(material);
    advance(state, {1.001, 0.003, 0, 0.998}, 3);
    write_packing(prefix, as_packing(*material, state.committed()));
    MaterialDescription again = describe(
        read_packing({prefix + "_particles.csv", prefix + "_contacts.csv", prefix + "_cell.csv"}),
        law);
    const auto made = make_material(again);
    const auto& F = state.committed().deformation;
    const auto& P = state.committed().stress;
    const double det = F[0] * F[3] - F[1] * F[2];
    Tensor cauchy = product({P[0], P[1], P[2], P[3]}, transpose({F[0], F[1], F[2], F[3]}));
    for (double& value : cauchy) value /= det;
    const auto& found = made->initial.stress;
    EXPECT_LE(relative_difference(Tensor{found[0], found[1], found[2], found[3]}, cauchy), 1e-6)
        << name;
    EXPECT_EQ(made->initial.broken_bonds, 0) << name;
  }
}

TEST(law_state, a_generated_packing_bears) {
  for (const auto& law : {hertz_law(), bonded_law(1), rolling_law(), compressive_law()}) {
    MaterialDescription description;
    GeneratorOptions options;
    options.count = 60;
    options.seed = 2;
    options.pressure = 1e5;
    description.generator = options;
    description.law = law;
    const auto material = make_material(description);
    const auto& P = material->initial.stress;
    EXPECT_NEAR(P[0], -1e5, 1);
    EXPECT_NEAR(P[3], -1e5, 1);
  }
}

}  // namespace
}  // namespace grainlaw::core::test

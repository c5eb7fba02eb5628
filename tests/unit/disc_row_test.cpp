// Two or three discs in a row that closes on itself in a cell, with room across: nothing holds the
// row against a motion sideways.
#include "disc_row.hpp"
#include "law_support.hpp"
#include "tangent_support.hpp"

namespace grainlaw::core::test {
namespace {

const std::vector<double> rows[] = {
    {1e-3, 1e-3}, {1e-3, 0.7e-3}, {1e-3, 1e-3, 1e-3}, {1e-3, 0.8e-3, 0.6e-3}};

// Change of the force along the row over the strain [N].
double line_stiffness(const Packing& packing, const ContactLaw& law) {
  double compliance = 0;
  const auto n = packing.size();
  for (std::size_t k = 0; k < n; ++k) {
    compliance += 1 / law.stiffness(packing.radius[k], packing.radius[(k + 1) % n]);
  }
  return packing.cell[0] / compliance;
}

TEST(disc_row, bears_along_its_length_by_springs_in_line) {
  for (const auto& radii : rows) {
    for (const auto& law :
         {compressive_law(), rough_law(), bonded_law(1e6), locked_bonded_law(1e6)}) {
      for (const double overlap : {0.0, 1e-6}) {
        const Packing packing = disc_row(radii, overlap);
        MaterialDescription description = describe(packing, law);
        description.solver.contacts_lost = ContactsLost::stress_free;
        State state(make_material(description));
        const double width = packing.cell[3] * packing.thickness;
        const double start = evaluate(state, identity).stress[0];
        for (const double strain : {-1e-8, -1e-4, -2e-3}) {
          const double change = evaluate(state, {1 + strain, 0, 0, 1}).stress[0] - start;
          const double expected = line_stiffness(packing, law) * strain / width;
          EXPECT_NEAR(change, expected, 1e-6 * std::abs(expected));
        }
        const double pulled = evaluate(state, {1 + 2e-3, 0, 0, 1}).stress[0];
        EXPECT_EQ(pulled > 0, law.bonds());
        EXPECT_EQ(pulled == 0, !law.bonds());
      }
    }
  }
}

TEST(disc_row, tangent_is_the_derivative) {
  for (const auto& radii : rows) {
    for (const auto& law :
         {compressive_law(), rough_law(), hertz_law(), bonded_law(1e6), locked_bonded_law(1e6)}) {
      MaterialDescription description = describe_law(disc_row(radii, 0), law);
      description.solver.contacts_lost = ContactsLost::stress_free;
      State state(make_material(description));
      expect_derivative(state, {1 - 1e-4, 0, 0, 1});
      advance(state, {1 - 1e-4, 0, 0, 1});
      expect_derivative(state, {1 - 2e-3, 1e-4, 2e-4, 1.001});
      if (law.bonds()) expect_derivative(state, {1 + 1e-3, 0, 1e-4, 1});
      advance(state, {1.001, 0, 0, 1});
      expect_derivative(state, {0.999, 0, 0, 0.99});
      expect_derivative(state, product(rotation(0.3), {0.998, 0, 1e-4, 1.01}));
    }
  }
}

// What holds a bonded row without any force in it is the springs alone.
TEST(disc_row, tangent_of_bonds_without_force_is_the_derivative) {
  for (const auto& radii : rows) {
    for (const auto& law : {bonded_law(1e6), locked_bonded_law(1e6)}) {
      State state(make_material(describe(disc_row(radii, 0), law)));
      EXPECT_LE(norm(evaluate(state, identity).stress), 1e-3);
      const Evaluation at = evaluate(state, identity, TangentKind::exact);
      EXPECT_EQ(at.report.tangent_exact, 1);
      constexpr double step = 1e-7;
      Tangent differences{};
      for (std::size_t k = 0; k < 4; ++k) {
        for (const double side : {1.0, -1.0}) {
          Tensor F = identity;
          F[k] += side * step;
          const Tensor stress = evaluate(state, F).stress;
          for (std::size_t m = 0; m < 4; ++m) {
            differences[m * 4 + k] += side * stress[m] / (2 * step);
          }
        }
      }
      EXPECT_LE(relative_difference(at.tangent, differences), bar);
    }
  }
}

}  // namespace
}  // namespace grainlaw::core::test

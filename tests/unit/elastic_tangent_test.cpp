// The elastic tangent is the affine estimate of Guo & Zhao (2014) eq. 9 as dP/dF, turned with the
// increment as P is: C_iJkL = (1/V0) sum w (kn n_i n_k + kt t_i t_k) L_J L_L over the contacts.
#include "boundary_support.hpp"
#include "law_support.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double rounding = 1e-10;
constexpr Tensor reached{1.0002, 1e-4, -2e-4, 0.999};
constexpr Tensor next{1.0004, 3e-4, -1e-4, 0.998};

// A disc that rattles may touch by chance: that has a stiffness, and is no contact of the state.
const Packing& firm() {
  static const Packing packing = firm_packing();
  return packing;
}
constexpr double pressure = 2e6;  // of that packing [Pa]

Tensor inverse(const Tensor& a) {
  const double det = a[0] * a[3] - a[1] * a[2];
  return {a[3] / det, -a[1] / det, -a[2] / det, a[0] / det};
}

Tensor contracted(const Tangent& tangent, const Tensor& change) {
  Tensor result{};
  for (std::size_t m = 0; m < 4; ++m) {
    for (std::size_t k = 0; k < 4; ++k) result[m] += tangent[4 * m + k] * change[k];
  }
  return result;
}

// kn and kt at an overlap.
std::array<double, 2> stiffnesses(const ContactLaw& law, double a, double b, double overlap) {
  const double r = 2 * a * b / (a + b);
  if (law.kind == LawKind::hertz) {
    const double root = std::sqrt(2 * r * overlap);
    const double kt = law.friction > 0 ? 2 * law.shear_modulus / (2 - law.poisson) * root : 0;
    return {law.shear_modulus / (1 - law.poisson) * root, kt};
  }
  const double kn = law.stiffness(a, b);
  return {kn, law.friction > 0 ? law.ratio * kn : 0};
}

// The branch that F deforms: a condition bound to axes moves discs by their place at F = I.
std::array<double, 2> reference_branch(const State& state, const ContactView& c) {
  const auto& space = state.material().space;
  if (space.bound_to_axes()) {
    const auto n = state.material().packing.size();
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    return {space.reference[j] - space.reference[i],
            space.reference[n + j] - space.reference[n + i]};
  }
  const Tensor back = inverse(deformation_of(state));
  return {back[0] * c.branch[0] + back[1] * c.branch[1],
          back[2] * c.branch[0] + back[3] * c.branch[1]};
}

Tangent sum_over_contacts(const State& state) {
  const Material& material = state.material();
  const auto& radius = material.packing.radius;
  Tangent tangent{};
  for (const ContactView& c : contact_views(material.problem(), state.current())) {
    const ContactLaw law = c.bonded ? material.law.of_bonds() : material.law;
    const auto [kn, kt] = stiffnesses(law, radius[static_cast<std::size_t>(c.i)],
                                      radius[static_cast<std::size_t>(c.j)], c.overlap);
    const double d = std::hypot(c.branch[0], c.branch[1]);
    const std::array<double, 2> n{c.branch[0] / d, c.branch[1] / d};
    const std::array<double, 2> t{-n[1], n[0]};
    const auto L = reference_branch(state, c);
    for (std::size_t m = 0; m < 4; ++m) {
      for (std::size_t k = 0; k < 4; ++k) {
        tangent[4 * m + k] += c.weight * (kn * n[m / 2] * n[k / 2] + kt * t[m / 2] * t[k / 2]) *
                              L[m % 2] * L[k % 2] / material.space.reference_volume;
      }
    }
  }
  return tangent;
}

// By a spin P turns; by the stretches R S F0, S symmetric, it changes as the sum has it. Together
// these are all directions.
void expect_the_sum_turned_with_the_increment(const State& state, const Evaluation& at,
                                              const Tensor& from, const Tensor& to) {
  const Tangent sums = sum_over_contacts(state);
  constexpr Tensor spin{0, -1, 1, 0};
  const Tensor by_spin = contracted(at.tangent, product(spin, to));
  EXPECT_LE(norm(sum(by_spin, -1, product(spin, at.stress))), rounding * norm(sums));
  const Tensor increment = product(to, inverse(from));
  const Tensor R = rotation(std::atan2(increment[2] - increment[1], increment[0] + increment[3]));
  for (const Tensor& S : {Tensor{1, 0, 0, 0}, Tensor{0, 1, 1, 0}, Tensor{0, 0, 0, 1}}) {
    const Tensor change = product(product(R, S), from);
    EXPECT_LE(relative_difference(contracted(at.tangent, change), contracted(sums, change)),
              rounding);
  }
}

struct Number {
  int sliding = 0, copied = 0, pulled = 0;
};

void expect_sum(const MaterialDescription& description, Number& number, const Tensor& to = next) {
  State state(make_material(description));
  advance(state, reached);
  for (const double angle : {0.0, 0.7}) {
    const Tensor F = product(rotation(angle), to);
    const Evaluation at = evaluate(state, F, TangentKind::elastic);
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    EXPECT_EQ(at.report.tangent_exact, 0);
    expect_the_sum_turned_with_the_increment(state, at, reached, F);
    number.sliding += at.report.sliding;
    for (const auto& c : contact_views(state.material().problem(), state.current())) {
      number.copied += c.weight < 1 ? 1 : 0;
      number.pulled += c.normal_force < 0 ? 1 : 0;
    }
  }
}

TEST(elastic_tangent, is_the_sum_over_the_contacts_of_any_law) {
  Number number;
  auto laws = composite_laws();
  laws.push_back({"frictional", rough_law()});
  laws.push_back({"frictional, locked", locked_law()});
  for (const auto& [name, law] : laws) {
    SCOPED_TRACE(name);
    expect_sum(describe_law(firm(), law), number);
  }
  EXPECT_GT(number.sliding, 0);  // they count as if they stuck
}

TEST(elastic_tangent, is_the_sum_over_the_contacts_without_tangential_forces) {
  Number number;
  for (const auto& law : {smooth_law(), smooth_hertz_law(), compressive_law()}) {
    expect_sum(describe_law(firm(), law), number);
  }
}

TEST(elastic_tangent, has_the_bonds_in_tension) {
  Number number;
  expect_sum(describe_law(firm(), bonded_law(1e4)), number, {1.02, 3e-4, -1e-4, 1.02});
  EXPECT_GT(number.pulled, 0);
}

TEST(elastic_tangent, counts_copies_on_a_frame_once) {
  Number number;
  for (const auto& law : {rough_law(), hertz_law(), bonded_law(1)}) {
    expect_sum(describe_law(firm(), law, BoundaryType::frame_p), number);
  }
  EXPECT_GT(number.copied, 0);
}

// What the state under prescribed stresses has, and the same contacts when F is given instead.
struct Condensation {
  Tangent condensed{}, whole{};
};

Condensation condense(MaterialDescription description, const Tensor& F) {
  State state(make_material(description));
  advance(state, {1, 2e-4, 0, 1});
  Condensation result;
  result.condensed = evaluate(state, F, TangentKind::elastic).tangent;
  EXPECT_TRUE(state.commit());

  description.boundary.stress = {};
  State given(make_material(description));
  given.restore(state.committed());
  const Evaluation at = evaluate(given, deformation_of(state), TangentKind::elastic);
  EXPECT_EQ(at.status, GRAINLAW_OK) << at.report.message;
  EXPECT_LE(relative_difference(at.tangent, sum_over_contacts(given)), rounding);
  result.whole = at.tangent;
  return result;
}

constexpr double solved = 1e-8;  // both to the solver's tolerance

TEST(elastic_tangent, of_a_layer_is_a_schur_complement) {
  for (const auto row : {SideRow::discs, SideRow::rigid}) {
    const auto [condensed, whole] =
        condense(describe_layer(firm(), -1.1 * pressure, row), {1.0001, 5e-4, 2e-4, 1});
    Tangent expected{};
    for (std::size_t m = 0; m < 3; ++m) {
      for (std::size_t k = 0; k < 3; ++k) {
        expected[4 * m + k] = whole[4 * m + k] - whole[4 * m + 3] * whole[12 + k] / whole[15];
      }
    }
    EXPECT_LE(relative_difference(condensed, expected), solved);
  }
}

TEST(elastic_tangent, under_two_prescribed_stresses_is_a_schur_complement) {
  auto description = describe_layer(firm(), -1.1 * pressure);
  description.boundary.stress[1] = 0.05 * pressure;
  const auto [condensed, whole] = condense(description, {1.0001, 0, 2e-4, 1});
  // F12 and F22 by F11 and F21 from two equations, by Cramer's rule.
  const double det = whole[5] * whole[15] - whole[7] * whole[13];
  Tangent expected{};
  for (const std::size_t m : {0U, 2U}) {
    for (const std::size_t k : {0U, 2U}) {
      const double f12 = (whole[7] * whole[12 + k] - whole[15] * whole[4 + k]) / det;
      const double f22 = (whole[13] * whole[4 + k] - whole[5] * whole[12 + k]) / det;
      expected[4 * m + k] = whole[4 * m + k] + whole[4 * m + 1] * f12 + whole[4 * m + 3] * f22;
    }
  }
  EXPECT_LE(relative_difference(condensed, expected), solved);
}

}  // namespace
}  // namespace grainlaw::core::test

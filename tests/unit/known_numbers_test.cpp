// Known numbers in the limit of no pressure: lattices against sums over their neighbours, per radius, kn and
// kt.
#include "sphere_support.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core::known {
namespace {

constexpr double radius = 1e-3, d = 2 * radius, kn = 1e4, no_load = 1e-9;

ContactLaw law_of(double ratio) {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = ratio;
  law.friction = 0.4;
  return law;
}

template <int D>
MaterialDescription lattice(GeneratorKind kind, const ContactLaw& law) {
  MaterialDescription description;
  description.packing.dimension = D;
  description.generator.emplace();
  description.generator->kind = kind;
  description.generator->radius_max = radius;
  description.generator->overlap = no_load * d;
  description.law = law;
  return description;
}

struct Constants {
  double normal, across, shear;  // C11, C12, C44 or in the plane C66
};

template <int D>
Constants constants(MaterialDescription description) {
  State<D> state(make_material<D>(std::move(description)));
  Tensor<D> F{}, stress{};
  for (std::size_t k = 0; k < D; ++k) F[(D + 1) * k] = 1;
  Tensor4<D> a{};
  grainlaw_report report{};
  EXPECT_EQ(state.evaluate(F.data(), TangentKind::exact, stress.data(), a.data(), report),
            GRAINLAW_OK)
      << report.message;
  return {a[0], a[D + 1], a[D * D + 1]};
}

template <int D>
void expect(GeneratorKind kind, double ratio, const Constants& wanted) {
  const Constants found = constants<D>(lattice<D>(kind, law_of(ratio)));
  EXPECT_NEAR(found.normal / kn * d, wanted.normal, 1e-7);
  EXPECT_NEAR(found.across / kn * d, wanted.across, 1e-7);
  EXPECT_NEAR(found.shear / kn * d, wanted.shear, 1e-7);
}

TEST(known_numbers, face_centred_and_simple_cubic_spheres) {
  for (const double r : {0.0, 0.4, 1.0}) {
    const double unit = std::sqrt(2.0);
    expect<3>(GeneratorKind::fcc, r, {unit * (1 + r), (1 - r) / unit, (1 + r) / unit});
    expect<3>(GeneratorKind::sc, r, {1, 0, r / 2});
  }
}

TEST(known_numbers, hexagonal_discs) {
  for (const double r : {0.0, 0.4, 1.0}) {
    const Constants found = constants<2>([&] {
      auto description = lattice<2>(GeneratorKind::hexagonal, law_of(r));
      description.generator->columns = description.generator->rows = 4;
      description.generator->thickness = 1;
      return description;
    }());
    const double unit = std::sqrt(3.0) / 4 * kn;
    EXPECT_NEAR(found.normal / unit, 3 + r, 1e-6);
    EXPECT_NEAR(found.across / unit, 1 - r, 1e-6);
    EXPECT_NEAR(found.shear / unit, 1 + r, 1e-6);
  }
}

// Duffy & Mindlin (1957): the wave speed, the square root of the stiffness, goes with the sixth.
TEST(known_numbers, stiffness_of_hertz_contacts_goes_with_a_third_of_the_pressure) {
  ContactLaw hertz = law_of(0.8);
  hertz.kind = LawKind::hertz;
  hertz.shear_modulus = 1e10;
  hertz.poisson = 0.2;
  const auto at = [&](double pressure) {
    auto description = lattice<3>(GeneratorKind::fcc, hertz);
    description.generator->overlap.reset();
    description.generator->pressure = pressure;
    return constants<3>(std::move(description));
  };
  const Constants low = at(1e3), high = at(8e3);
  for (const auto part : {&Constants::normal, &Constants::across, &Constants::shear}) {
    EXPECT_NEAR(std::log(high.*part / (low.*part)) / std::log(8.0), 1.0 / 3, 1e-3);
  }
}

}  // namespace
}  // namespace grainlaw::core::known

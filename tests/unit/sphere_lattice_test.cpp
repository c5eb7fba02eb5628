// Lattices of spheres: neighbours, pressure, and elastic constants against closed forms.
#include "base/error.hpp"
#include "generate/compaction.hpp"
#include "generate/sphere_lattices.hpp"
#include "packing/neighbours.hpp"
#include "sphere_support.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace grainlaw::core::sphere_test {
namespace {

constexpr double radius = 1e-3, kn = 1e4, overlap = 2e-6;
constexpr auto kinds = {GeneratorKind::sc, GeneratorKind::bcc, GeneratorKind::fcc,
                        GeneratorKind::hcp};

ContactLaw law_of(double ratio) {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = ratio;
  law.friction = 0.4;
  return law;
}

GeneratorOptions lattice(GeneratorKind kind, std::array<std::size_t, 3> cells = {2, 2, 2}) {
  GeneratorOptions options;
  options.kind = kind;
  options.cells = cells;
  options.radius_max = radius;
  options.overlap = overlap;
  return options;
}

MaterialDescription generated(const GeneratorOptions& options, const ContactLaw& law) {
  MaterialDescription description;
  description.packing.dimension = 3;
  description.generator = options;
  description.law = law;
  return description;
}

TEST(sphere_lattices, have_their_neighbours) {
  for (const GeneratorKind kind : kinds)
    for (const std::array<std::size_t, 3> cells :
         {std::array<std::size_t, 3>{1, 1, 1}, {3, 2, 4}}) {
      const Packing packing = sphere_lattice(kind, cells, 1.02, 2);
      std::vector<NeighbourPair<3>> pairs;
      NeighbourSearch<3>().find(packing.size(), packing.position.data(), packing.radius.data(),
                                packing.cell.data(), 0, pairs);
      const std::size_t half = kind == GeneratorKind::sc ? 3 : kind == GeneratorKind::bcc ? 4 : 6;
      EXPECT_EQ(pairs.size(), half * packing.size());
    }
}

TEST(sphere_lattices, rest_at_the_pressure_wanted) {
  ContactLaw hertz = law_of(0.8);
  hertz.kind = LawKind::hertz;
  hertz.shear_modulus = 1e8;
  hertz.poisson = 0.2;
  for (const GeneratorKind kind : kinds)
    for (const ContactLaw& law : {law_of(0.5), hertz})
      for (const double pressure : {1e3, 1e5}) {
        GeneratorOptions options = lattice(kind);
        options.overlap.reset();
        options.pressure = pressure;
        const auto material = make_material<3>(generated(options, law));
        const auto& stress = material->initial.stress;
        for (std::size_t k = 0; k < 9; ++k) {
          EXPECT_NEAR(stress[k] / pressure, k % 4 == 0 ? -1 : 0, 1e-9) << k;
        }
      }
}

// Stiffness, 6 x 6 by (11, 22, 33, 23, 13, 12) with engineering shears, of affine lattices under a stretch U.
// Every contact gives
//   l l (kn n n n n + s n n (1 - n n)) / V, s = kt - fn / d:
// the force fn turns with the branch, which counts like a softer spring. No sphere turns, since the sum of n n
// is isotropic. Summed by hand over the 3 and 6 contacts that a sphere has.
struct Constants {
  double c11, c12, c13, c33, c44, c66;
};

Constants simple_cubic(double s, double d) {
  return {kn / d, 0, 0, kn / d, s / (2 * d), s / (2 * d)};
}

Constants face_centred(double s, double d) {
  const double unit = std::sqrt(2.0) / d;
  const double c12 = unit * (kn - s) / 2, c44 = unit * (kn + s) / 2;
  return {unit * (kn + s), c12, c12, unit * (kn + s), c44, c44};
}

// In the basal plane its two layers move against each other by what leaves no force between them.
Constants hexagonal_close(double s, double d) {
  const double unit = std::sqrt(2.0) / d;
  const double moved = (kn - s) * (kn - s) / (24 * (kn + 5 * s));
  return {unit * (1.25 * kn + 0.75 * s - moved),
          unit * (5.0 / 12 * (kn - s) + moved),
          unit * (kn - s) / 3,
          unit * (4 * kn + 2 * s) / 3,
          unit * (kn + 2 * s) / 3,
          unit * (5 * kn + 7 * s) / 12 - unit * moved};
}

// dP = C sym(dF) + skew(dF) P.
Tensor4<3> tangent_of(const Constants& c, double pressure) {
  Tensor4<3> a{};
  for (std::size_t k = 0; k < 9; ++k) {
    Deformation stretch{}, spin{};
    const std::size_t transposed = 3 * (k % 3) + k / 3;
    stretch[k] += 0.5;
    stretch[transposed] += 0.5;
    spin[k] += 0.5;
    spin[transposed] -= 0.5;
    Deformation p{};
    p[0] = c.c11 * stretch[0] + c.c12 * stretch[4] + c.c13 * stretch[8];
    p[4] = c.c12 * stretch[0] + c.c11 * stretch[4] + c.c13 * stretch[8];
    p[8] = c.c13 * (stretch[0] + stretch[4]) + c.c33 * stretch[8];
    p[5] = p[7] = 2 * c.c44 * stretch[5];
    p[2] = p[6] = 2 * c.c44 * stretch[2];
    p[1] = p[3] = 2 * c.c66 * stretch[1];
    for (std::size_t m = 0; m < 9; ++m) a[9 * m + k] = p[m] - pressure * spin[m];
  }
  return a;
}

TEST(sphere_lattices, have_the_elastic_constants_of_closed_forms) {
  const double d = 2 * radius - overlap;
  for (const double ratio : {0.0, 0.5, 1.0}) {
    const double s = ratio * kn - kn * overlap / d;
    const auto compare = [&](GeneratorKind kind, const Constants& constants) {
      State<3> state(make_material<3>(generated(lattice(kind), law_of(ratio))));
      const auto found = evaluate(state, identity<3>(), TangentKind::exact);
      const double pressure = -found.stress[0];
      EXPECT_NEAR(pressure, pressure_share(kind) * kn * overlap / (d * d), 1e-9 * pressure);
      const auto expected = tangent_of(constants, pressure);
      const double scale = *std::max_element(expected.begin(), expected.end());
      for (std::size_t k = 0; k < 81; ++k) {
        EXPECT_NEAR(found.tangent[k], expected[k], 1e-10 * scale) << ratio << ' ' << k;
      }
      EXPECT_EQ(found.report.tangent_exact, 1);
    };
    compare(GeneratorKind::sc, simple_cubic(s, d));
    compare(GeneratorKind::fcc, face_centred(s, d));
    compare(GeneratorKind::hcp, hexagonal_close(s, d));
  }
}

// Where the affine image is the equilibrium, a change of one component of F follows the same constants.
TEST(sphere_lattices, follow_a_small_strain_by_their_constants) {
  const double d = 2 * radius - overlap;
  const double ratio = 0.5, strain = 1e-7;
  State<3> state(make_material<3>(generated(lattice(GeneratorKind::fcc), law_of(ratio))));
  const auto at_rest = evaluate(state, identity<3>()).stress;
  const auto expected = tangent_of(face_centred(ratio * kn - kn * overlap / d, d), -at_rest[0]);
  for (std::size_t k = 0; k < 9; ++k) {
    Deformation F = identity<3>();
    F[k] += strain;
    const auto stress = evaluate(state, F).stress;
    for (std::size_t m = 0; m < 9; ++m) {
      EXPECT_NEAR((stress[m] - at_rest[m]) / strain, expected[9 * m + k], 1e-5 * expected[0]);
    }
  }
}

TEST(sphere_lattices, refuse_what_cannot_be) {
  const auto refused = [](auto change) {
    GeneratorOptions options = lattice(GeneratorKind::bcc);
    change(options);
    EXPECT_THROW(consolidate<3>(options, law_of(0.5)), Error);
  };
  refused([](auto& o) { o.cells[1] = 0; });
  refused([](auto& o) { o.cells[2] = 101; });
  refused([](auto& o) { o.radius_max = 0; });
  refused([](auto& o) { o.overlap = -1e-9; });
  refused([](auto& o) { o.overlap = 0.27 * radius; });  // the second neighbours would touch
  refused([](auto& o) { o.overlap.reset(), o.pressure = 1e8; });
  refused(
      [](auto& o) { o.overlap.reset(), o.pressure = std::numeric_limits<double>::quiet_NaN(); });
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

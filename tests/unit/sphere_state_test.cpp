// States of sphere packings: stress, tangents, rotations, bytes; and a layer of spheres against discs.
#include "sphere_support.hpp"

#include "../data.hpp"
#include "base/error.hpp"
#include "homogenise/measures.hpp"
#include "state/serialise.hpp"

#include <algorithm>
#include <vector>

namespace grainlaw::core::sphere_test {
namespace {

// Along the drained path of the reference, roughly.
Deformation drained(double strain) {
  return {1 + 0.35 * strain, 0, 0, 0, 1 + 0.35 * strain, 0, 0, 0, 1 - strain};
}

TEST(spheres, start_from_the_stress_they_were_made_at) {
  const auto material = make_material<3>(describe());
  const auto& p = material->initial.stress;
  for (const std::size_t k : {0U, 4U, 8U}) EXPECT_NEAR(p[k], -1e5, 500) << k;
  EXPECT_EQ(material->initial.contacts.size(), 1548U);
}

TEST(spheres, cauchy_stress_is_symmetric) {
  State<3> state(make_material<3>(describe()));
  evaluate(state, drained(1e-3));
  Deformation sigma{};
  measure(state.material().problem(), state.current(), GRAINLAW_CAUCHY_STRESS, sigma.data());
  const double scale = norm(sigma);
  EXPECT_NEAR(sigma[1], sigma[3], 1e-8 * scale);
  EXPECT_NEAR(sigma[2], sigma[6], 1e-8 * scale);
  EXPECT_NEAR(sigma[5], sigma[7], 1e-8 * scale);
}

TEST(spheres, rotation_turns_stress_and_particles) {
  const auto material = make_material<3>(describe());
  const Deformation F = drained(5e-4);
  State<3> state(material);
  const auto stress = evaluate(state, F).stress;
  for (const double angle : {0.3, 3.0}) {
    const Deformation Q = rotation({1, 2, -0.5}, angle);
    State<3> turned(material);
    const auto found = evaluate(turned, product<3>(Q, F)).stress;
    EXPECT_LT(relative_difference(found, product<3>(Q, stress)), 1e-10) << angle;
    Vec<3> mean{}, mean_turned{};
    measure(material->problem(), state.current(), GRAINLAW_MEAN_ROTATION, mean.data());
    measure(material->problem(), turned.current(), GRAINLAW_MEAN_ROTATION, mean_turned.data());
    EXPECT_LT(length<3>(mean), 0.05 * angle);
    EXPECT_NEAR(length<3>(mean_turned), angle, 0.05 * angle);
    // Springs too: the next increment starts from what both committed.
    turned.commit();
    State<3> straight(material);
    evaluate(straight, F);
    straight.commit();
    const Deformation next = drained(1e-3);
    EXPECT_LT(relative_difference(evaluate(turned, product<3>(Q, next)).stress,
                                  product<3>(Q, evaluate(straight, next).stress)),
              1e-9)
        << angle;
  }
}

TEST(spheres, tangent_matches_central_difference_also_through_parts) {
  for (const double limit : {1.0, 0.2}) {
    auto description = locked(describe(1e-11));
    description.solver.increment_limit = limit;
    State<3> state(make_material<3>(description));
    const Deformation F{1.0002, 1e-4, -1e-4, 0, 1.0001, 2e-4, 1e-4, 0, 0.9994};
    const auto found = evaluate(state, F, TangentKind::exact);
    EXPECT_EQ(found.report.tangent_exact, 1);
    if (limit < 1) {
      EXPECT_GT(found.report.subincrements, 1);
    }
    EXPECT_LT(relative_difference(found.tangent, central_differences(state, F, 1e-8)), 1e-6)
        << limit;
  }
}

TEST(spheres, saved_bytes_bring_the_state_back) {
  const auto material = make_material<3>(describe());
  State<3> state(material);
  evaluate(state, drained(5e-4));
  state.commit();
  std::vector<std::byte> bytes(saved_size(*material, state.committed()));
  save_configuration(*material, state.committed(), bytes);
  State<3> other(material);
  other.restore(load_configuration(*material, bytes));
  const auto a = evaluate(state, drained(1e-3)).stress;
  const auto b = evaluate(other, drained(1e-3)).stress;
  EXPECT_EQ(a, b);
  bytes[bytes.size() / 2] ^= std::byte{1};
  EXPECT_THROW(static_cast<void>(load_configuration(*material, bytes)), Error);
}

// The file says where spheres without contacts are; later rounding does.
TEST(spheres, that_bear_again_are_counted_where_an_increment_left_them_alone) {
  State<3> state(make_material<3>(describe()));
  std::vector<int> counts;
  for (int k = 1; k <= 3; ++k) {
    counts.push_back(evaluate(state, drained(1e-3 * k)).report.rattlers_loaded);
    state.commit();
  }
  EXPECT_EQ(counts.front(), 0);
  EXPECT_GT(counts[1] + counts[2], 0);
}

TEST(spheres, with_drag_have_no_rattlers_that_rounding_places) {
  MaterialDescription description = describe();
  description.solver.viscosity.number = 1e-3;
  State<3> state(make_material<3>(description));
  for (int k = 1; k <= 3; ++k) {
    EXPECT_EQ(evaluate(state, drained(1e-3 * k)).report.rattlers_loaded, 0) << k;
    state.commit();
  }
}

// Discs seen as spheres between two walls of symmetry: one deep, in a cell higher than they are.
TEST(layer_of_spheres, is_the_disc_packing) {
  const std::string data = grainlaw::test::data_file("rve400_");
  MaterialDescription discs;
  discs.packing = read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"});
  discs.law.young = 6e8;
  discs.law.ratio = 0.8;
  discs.law.friction = std::tan(0.5);
  discs.solver.tolerance = 1e-12;
  MaterialDescription spheres = discs;
  const auto n = discs.packing.size();
  const double height = 0.02;
  spheres.packing.dimension = 3;
  spheres.packing.position.resize(3 * n, 0.0);
  const auto& h = discs.packing.cell;
  spheres.packing.cell = {h[0], h[1], 0, h[2], h[3], 0, 0, 0, height};
  State<2> plane(make_material<2>(discs));
  State<3> space(make_material<3>(spheres));
  const double thickness = discs.packing.thickness;
  double worst = 0;
  double worst_tangent = 0;
  for (int k = 1; k <= 50; ++k) {
    const double e = 2e-6 * k;
    const Tensor<2> f{1 + 0.3 * e, 0.2 * e, 0, 1 - e};
    const Deformation F{f[0], f[1], 0, f[2], f[3], 0, 0, 0, 1};
    Tensor<2> p{};
    grainlaw_report report{};
    Tensor4<2> a{};
    ASSERT_EQ(plane.evaluate(f.data(), TangentKind::exact, p.data(), a.data(), report),
              GRAINLAW_OK);
    const auto found = evaluate(space, F, TangentKind::exact);
    const Tensor<2> line{found.stress[0] * height / thickness, found.stress[1] * height / thickness,
                         found.stress[3] * height / thickness,
                         found.stress[4] * height / thickness};
    worst = std::max(worst, relative_difference(line, p));
    constexpr std::array<std::size_t, 4> in_plane{0, 1, 3, 4};
    Tensor4<2> tangent{};
    for (std::size_t m = 0; m < 4; ++m) {
      for (std::size_t l = 0; l < 4; ++l) {
        tangent[4 * m + l] = found.tangent[9 * in_plane[m] + in_plane[l]] * height / thickness;
      }
    }
    worst_tangent = std::max(worst_tangent, relative_difference(tangent, a));
    EXPECT_NEAR(found.stress[8], 0, 1e-9 * norm(p));
    plane.commit();
    space.commit();
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(worst_tangent, 1e-9);
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

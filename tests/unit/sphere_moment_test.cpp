// Rolling, twisting, bending and torsion of spheres: closed forms, the vector loops against one contact, and
// derivatives against differences.
#include "tangent/stiffness.hpp"

#include "few_spheres.hpp"
#include "generate/compaction.hpp"
#include "sphere_support.hpp"

#include <algorithm>

namespace grainlaw::core::sphere_test {
namespace {

constexpr double kn = 1000, ratio = 0.5, overlap = 0.02;

ContactLaw rolling_law() {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = ratio;
  law.friction = 0.4;
  law.rolling = {0.3, 0.1, 0.2, 0.05};
  return law;
}

ContactLaw bonded_law() {
  ContactLaw law;
  law.kind = LawKind::bonded;
  law.normal_stiffness = kn;
  law.ratio = ratio;
  law.friction = 0.4;
  law.bond = {.normal_strength = 50,
              .tangential_strength = 40,
              .bending_strength = 30,
              .bending_stiffness = 70,
              .torsion_strength = 20,
              .torsion_stiffness = 90};
  return law;
}

// Two unit spheres along x.
Spheres two(const ContactLaw& law) { return Spheres(law, {1, 1}, {0, 2 - overlap, 0, 0, 0, 0}); }

constexpr Vec<3> x_axis{1, 0, 0}, z_axis{0, 0, 1};

TEST(two_spheres, resist_rolling_up_to_a_moment) {
  for (const double angle : {1e-3, 0.01, 0.03, -0.03}) {
    Spheres spheres = two(rolling_law());
    spheres.turn(0, z_axis, -0.5 * angle);
    spheres.turn(1, z_axis, 0.5 * angle);
    const double fn = kn * overlap;
    const double trial = -0.3 * ratio * kn * 2 * std::sin(0.5 * angle);
    const double bound = 0.1 * fn;
    const auto moment = spheres.moment();
    EXPECT_LT(length<3>(spheres.point().tangential_force), 1e-12);
    EXPECT_NEAR(moment.moment[2], std::clamp(trial, -bound, bound), 1e-12);
    EXPECT_NEAR(std::hypot(moment.moment[0], moment.moment[1]), 0, 1e-14);
    const auto f = spheres.forces();
    EXPECT_NEAR(f[1].spin_z, moment.moment[2], 1e-12);
    EXPECT_NEAR(f[0].spin_z, -moment.moment[2], 1e-12);
  }
}

TEST(two_spheres, resist_twisting_up_to_a_moment_of_its_own) {
  for (const double angle : {1e-3, 5e-3, 0.05, -0.05}) {
    Spheres spheres = two(rolling_law());
    spheres.turn(1, x_axis, angle);
    const double trial = -0.2 * ratio * kn * 2 * std::sin(0.5 * angle);
    const double bound = 0.05 * kn * overlap;
    EXPECT_NEAR(spheres.moment().moment[0], std::clamp(trial, -bound, bound), 1e-12);
    EXPECT_NEAR(spheres.forces()[1].spin_x, spheres.moment().moment[0], 1e-12);
  }
}

TEST(two_spheres, turned_as_one_feel_no_moment) {
  for (const auto& law : {rolling_law(), bonded_law()}) {
    Spheres spheres = two(law);
    const Deformation q = rotation({1, -2, 0.5}, 0.7);
    const double size = std::sqrt(5.25);
    for (const std::size_t p : {0U, 1U}) {
      spheres.turn(p, {1 / size, -2 / size, 0.5 / size}, 0.7);
      for (std::size_t k = 0; k < 3; ++k) spheres.z[2 * k + p] = q[3 * k] * (p == 1 ? 1.98 : 0);
    }
    EXPECT_LT(length<3>(spheres.moment().moment), 1e-12);
    EXPECT_LT(length<3>(spheres.point().tangential_force), 1e-11);
  }
}

// Four equal spheres in a row along x, bonded without overlap.
Spheres beam() {
  return Spheres(bonded_law(), {1, 1, 1, 1}, {0, 2, 4, 6, 0, 0, 0, 0, 0, 0, 0, 0},
                 {{0, 1, {}}, {1, 2, {}}, {2, 3, {}}});
}

// A beam bent to an arc: every bond turns by the same angle and the branches lie half way between, so that
// there is no shear; inner spheres are in balance, and the ends need the moment of one bond.
TEST(bonded_beam, bends_to_an_arc_under_end_moments) {
  const double angle = 0.1;
  Spheres spheres = beam();
  for (std::size_t p = 1; p < 4; ++p) {
    const double direction = (static_cast<double>(p) - 0.5) * angle;
    spheres.z[p] = spheres.z[p - 1] + 2 * std::cos(direction);
    spheres.z[4 + p] = spheres.z[4 + p - 1] + 2 * std::sin(direction);
    spheres.turn(p, z_axis, static_cast<double>(p) * angle);
  }
  const double moment = 70 * 2 * std::sin(0.5 * angle);
  const auto f = spheres.forces();
  EXPECT_NEAR(f[0].spin_z, moment, 1e-11);
  EXPECT_NEAR(f[3].spin_z, -moment, 1e-11);
  for (const std::size_t p : {0U, 1U, 2U, 3U}) {
    EXPECT_NEAR(std::hypot(f[p].x, f[p].y, f[p].z), 0, 1e-11);
    if (p == 1 || p == 2) {
      EXPECT_NEAR(f[p].spin_z, 0, 1e-11);
    }
  }
}

TEST(bonded_beam, twists_uniformly_under_end_torques) {
  const double angle = 0.1;
  Spheres spheres = beam();
  for (std::size_t p = 1; p < 4; ++p) spheres.turn(p, x_axis, static_cast<double>(p) * angle);
  const double torque = 90 * 2 * std::sin(0.5 * angle);
  const auto f = spheres.forces();
  EXPECT_NEAR(f[0].spin_x, torque, 1e-11);
  EXPECT_NEAR(f[1].spin_x, 0, 1e-11);
  EXPECT_NEAR(f[2].spin_x, 0, 1e-11);
  EXPECT_NEAR(f[3].spin_x, -torque, 1e-11);
}

TEST(bonded_beam, carries_tension_and_shear) {
  Spheres spheres = beam();
  spheres.z[3] += 0.01;
  EXPECT_NEAR(spheres.forces()[3].x, -10, 1e-11);
  spheres.z[7] += 0.02;
  const double d = std::hypot(2.01, 0.02);
  EXPECT_NEAR(length<3>(spheres.point(2).tangential_force), ratio * kn * 0.02 / d * d, 1e-10);
}

TEST(bonds_of_spheres, are_loaded_by_bending_and_torsion_too) {
  Spheres spheres = beam();
  spheres.turn(3, x_axis, 0.1);
  const auto twisted = spheres.moment(2);
  EXPECT_NEAR(bond_share(twisted, spheres.law.bond), 90 * 2 * std::sin(0.05) / 20, 1e-12);
  spheres.turn(3, z_axis, 0.1);
  EXPECT_NEAR(bond_share(spheres.moment(2), spheres.law.bond), 70 * 2 * std::sin(0.05) / 30, 1e-12);
}

// The reference packing with moments, on its way to an increment.
MaterialDescription with_moments(LawKind kind, double tolerance = 1e-9) {
  MaterialDescription description = describe(tolerance);
  description.law.rolling = {0.5, 0.2, 0.3, 0.1};
  if (kind == LawKind::bonded) {
    description.law.kind = kind;
    const double r = 5e-3;
    description.law.bond = {.normal_strength = 1e9,
                            .tangential_strength = 1e9,
                            .bending_strength = 1e9,
                            .bending_stiffness = 0.2 * 1e8 * r * r * r,
                            .torsion_strength = 1e9,
                            .torsion_stiffness = 0.1 * 1e8 * r * r * r};
  } else if (kind == LawKind::hertz) {
    description.law.kind = kind;
    description.law.young = 0;
    description.law.shear_modulus = 1e9;
    description.law.poisson = 0.2;
    description.law.ratio = 2 * 0.8 / 1.8;
    description.packing.contacts.clear();
  }
  return description;
}

Increment<3>& moved(const Material<3>& material, Problem<3>& problem) {
  static Increment<3> increment;
  problem = material.problem();
  increment.begin(problem, material.initial, {1.0005, 1e-4, 0, 0, 1.0004, -2e-4, 0, 0, 0.999});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> z = increment.motion().coordinates();
  const std::size_t n = problem.particles();
  for (std::size_t k = 0; k < 3 * n; ++k) z[k] += 2e-7 * uniform(random);
  for (std::size_t k = 3 * n; k < 6 * n; ++k) z[k] = 1e-3 * uniform(random);
  increment.motion().go_to(z, increment.motion().deformation());
  increment.update_forces();
  increment.refresh_masses();
  return increment;
}

TEST(moment_loops, have_the_moments_of_single_contacts) {
  for (const LawKind kind : {LawKind::frictional, LawKind::bonded, LawKind::hertz}) {
    const auto material = make_material<3>(with_moments(kind));
    Problem<3> problem;
    auto& increment = moved(*material, problem);
    const auto& list = increment.contacts();
    const std::size_t n = problem.particles();
    std::vector<double> residual(6 * n, 0.0);
    double scale = 0;
    int rolling = 0;
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto& z = increment.motion().coordinates();
      const auto point = contact_point(list, c, z, n, material->law);
      if (point.status == ContactStatus::open) continue;
      const auto moment = contact_moment(list, c, point, z, n, material->law);
      const auto i = static_cast<std::size_t>(list.i[c]);
      const auto j = static_cast<std::size_t>(list.j[c]);
      const auto& radius = problem.packing->radius;
      const Vec<3> f = point.force_on_j();
      const Vec<3> couple = cross(point.branch, point.tangential_force);
      scale = std::max(scale, length<3>(f));
      rolling += length<3>(moment.moment) > 0 ? 1 : 0;
      for (std::size_t k = 0; k < 3; ++k) {
        residual[k * n + j] += f[k];
        residual[k * n + i] -= f[k];
        const double tau = -couple[k] / list.reach[c];
        residual[(3 + k) * n + j] += radius[j] * tau + moment.moment[k];
        residual[(3 + k) * n + i] += radius[i] * tau - moment.moment[k];
      }
    }
    EXPECT_GT(rolling, 1000);
    for (std::size_t k = 0; k < residual.size(); ++k) {
      ASSERT_NEAR(increment.residual()[k], residual[k], 1e-12 * scale) << k;
    }
  }
}

TEST(moment_stiffness, is_the_derivative_of_the_residual) {
  for (const LawKind kind : {LawKind::frictional, LawKind::bonded, LawKind::hertz}) {
    const auto material = make_material<3>(with_moments(kind));
    Problem<3> problem;
    auto& increment = moved(*material, problem);
    Stiffness<3> stiffness;
    const std::size_t n = problem.particles();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto radius = increment.motion().node_radius();
    std::vector<double> motion(6 * n);
    for (std::size_t k = 0; k < motion.size(); ++k) {
      motion[k] = (k < 3 * n ? radius[k % n] : 1.0) * uniform(random);
    }
    const auto before = increment.motion().coordinates();
    const auto F = increment.motion().deformation();
    std::array<std::vector<double>, 2> residual;
    constexpr double step = 1e-7;
    for (std::size_t side = 0; side < 2; ++side) {
      increment.motion().go_to(before, F);
      increment.motion().move(motion, side == 0 ? step : -step);
      increment.update_forces();
      residual[side].assign(increment.residual().begin(), increment.residual().end());
    }
    increment.motion().go_to(before, F);
    increment.update_forces();
    stiffness.assemble(increment, 0);
    double worst = 0;
    double scale = 0;
    const auto by_stiffness = stiffness.product(motion);
    for (std::size_t k = 0; k < motion.size(); ++k) {
      const double lever = k < 3 * n ? 1.0 : radius[k % n];
      const double difference = (residual[1][k] - residual[0][k]) / (2 * step);
      worst = std::max(worst, std::abs(by_stiffness[k] - difference) / lever);
      scale = std::max(scale, std::abs(difference) / lever);
    }
    EXPECT_LT(worst, 1e-6 * scale) << static_cast<int>(kind);
  }
}

Deformation strained(double strain) {
  return {1 + 0.35 * strain, 2e-4, 0, 0, 1 + 0.35 * strain, 1e-4, 0, 0, 1 - strain};
}

TEST(moments_of_spheres, turn_with_the_packing) {
  for (const LawKind kind : {LawKind::frictional, LawKind::bonded}) {
    const auto material = make_material<3>(with_moments(kind, 1e-12));
    const Deformation Q = rotation({1, 2, -0.5}, 2.0);
    State<3> state(material), turned(material);
    const auto stress = evaluate(state, strained(5e-4)).stress;
    const auto found = evaluate(turned, product<3>(Q, strained(5e-4))).stress;
    EXPECT_LT(relative_difference(found, product<3>(Q, stress)), 1e-10);
    state.commit();
    turned.commit();
    const Deformation next = strained(1e-3);
    EXPECT_LT(relative_difference(evaluate(turned, product<3>(Q, next)).stress,
                                  product<3>(Q, evaluate(state, next).stress)),
              1e-9);
  }
}

// So small that a hundred evaluations take little time.
const Packing& small_packing() {
  static const Packing packing = [] {
    GeneratorOptions options;
    options.count = 100;
    return consolidate<3>(options, describe().law);
  }();
  return packing;
}

TEST(moments_of_spheres, have_an_exact_tangent_also_through_parts) {
  for (const LawKind kind : {LawKind::frictional, LawKind::bonded, LawKind::hertz})
    for (const double limit : {1.0, 0.2}) {
      auto description = with_moments(kind, 1e-12);
      description.packing = small_packing();
      if (kind == LawKind::hertz) description.packing.contacts.clear();
      description.solver.increment_limit = limit;
      State<3> state(make_material<3>(description));
      evaluate(state, strained(2e-4));
      state.commit();
      const Deformation F = strained(6e-4);
      const auto found = evaluate(state, F, TangentKind::exact);
      EXPECT_EQ(found.report.tangent_exact, 1);
      EXPECT_LT(relative_difference(found.tangent, central_differences(state, F, 1e-8)), 1e-6)
          << static_cast<int>(kind) << ' ' << limit;
    }
}

// Every bond along x of a simple cubic lattice carries the same.
TEST(bonds_of_spheres, break_together_in_a_lattice_under_tension) {
  MaterialDescription description;
  description.packing.dimension = 3;
  description.law = bonded_law();
  GeneratorOptions options;
  options.kind = GeneratorKind::sc;
  options.cells = {2, 2, 2};
  options.radius_max = 1;
  options.overlap = 0;
  description.generator = options;
  State<3> state(make_material<3>(description));
  const auto broken = [&] {
    double number = 0;
    measure(state.material().problem(), state.current(), GRAINLAW_BROKEN_BONDS, &number);
    return number;
  };
  const double strain = 50 / (kn * 2);  // of the strength
  const auto stress = evaluate(state, {1 + 0.99 * strain, 0, 0, 0, 1, 0, 0, 0, 1}).stress;
  EXPECT_NEAR(stress[0], 0.99 * 50 / 4, 1e-9);
  EXPECT_EQ(broken(), 0);
  evaluate(state, {1 + 1.01 * strain, 0, 0, 0, 1 - 1e-4, 0, 0, 0, 1 - 1e-4});
  EXPECT_EQ(broken(), 8);
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

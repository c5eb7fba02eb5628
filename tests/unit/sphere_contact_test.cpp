// Contacts of spheres: closed forms, the vector loops against one contact, and the stiffness against
// differences.
#include "contact/contact_forces.hpp"
#include "contact/contact_point.hpp"
#include "increment/records.hpp"
#include "increment/rotations.hpp"
#include "tangent/stiffness.hpp"

#include "few_spheres.hpp"
#include "sphere_support.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace grainlaw::core::sphere_test {
namespace {

ContactLaw rough() {
  ContactLaw law;
  law.normal_stiffness = 1000;
  law.ratio = 0.5;
  law.friction = 0.4;
  return law;
}

// Two unit spheres along x that overlap by 0.02.
Spheres two(const ContactLaw& law) { return Spheres(law, {1, 1}, {0, 1.98, 0, 0, 0, 0}); }

TEST(two_spheres, press_each_other_apart) {
  Spheres spheres = two(rough());
  const auto f = spheres.forces();
  EXPECT_NEAR(f[1].x, 20, 1e-12);
  EXPECT_NEAR(f[0].x, -20, 1e-12);
  EXPECT_EQ(f[0].spin_z, 0);
}

TEST(two_spheres, stick_until_friction_and_then_slide) {
  for (const double by : {1e-3, 5e-3, 0.1}) {
    Spheres spheres = two(rough());
    spheres.z[3] = by;  // y of the second
    const double angle = std::atan2(by, 1.98);
    const double d = std::hypot(by, 1.98);
    const double fn = 1000 * (2 - d);
    const double trial = 500 * d * std::sin(angle);
    const auto point = spheres.point();
    EXPECT_NEAR(point.normal_force, fn, 1e-10);
    EXPECT_NEAR(length<3>(point.tangential_force), std::min(trial, 0.4 * std::max(fn, 0.0)), 1e-9);
  }
}

TEST(two_spheres, that_roll_on_each_other_feel_nothing) {
  Spheres spheres = two(rough());
  spheres.z[3 * 2 + 2 * 2] = 0.01;       // about z, the first
  spheres.z[3 * 2 + 2 * 2 + 1] = -0.01;  // and the second the other way
  EXPECT_LT(length<3>(spheres.point().tangential_force), 1e-12);
}

TEST(two_spheres, that_twist_about_their_branch_feel_nothing) {
  Spheres spheres = two(rough());
  spheres.z[3 * 2] = 0.3;  // about x
  EXPECT_LT(length<3>(spheres.point().tangential_force), 1e-12);
}

TEST(two_spheres, turned_by_the_same_spin_are_sheared) {
  Spheres spheres = two(rough());
  spheres.z[3 * 2 + 2 * 2] = spheres.z[3 * 2 + 2 * 2 + 1] = 1e-3;  // about z
  const double angle = 2 * std::atan(0.5e-3);
  EXPECT_NEAR(spheres.point().tangential_force[1], 500 * 1.98 * std::sin(angle), 1e-10);
}

TEST(two_spheres, bring_no_moment_into_the_world) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  Spheres spheres(rough(), {1, 0.7}, {0, 0.9, 0, 1.1, 0, 0.8});
  for (double& value : spheres.z) value += 0.01 * uniform(random);
  for (std::size_t k = 6; k < 12; ++k) spheres.z[k] = uniform(random);
  const auto f = spheres.forces();
  const auto point = spheres.point();
  const Vec<3> force{f[1].x, f[1].y, f[1].z};
  const Vec<3> couple = cross(point.branch, force);
  EXPECT_NEAR(couple[0] + f[0].spin_x + 0.7 * f[1].spin_x, 0, 1e-12);
  EXPECT_NEAR(couple[1] + f[0].spin_y + 0.7 * f[1].spin_y, 0, 1e-12);
  EXPECT_NEAR(couple[2] + f[0].spin_z + 0.7 * f[1].spin_z, 0, 1e-12);
}

TEST(two_spheres, hertz_force_goes_with_the_overlap_to_three_halves) {
  ContactLaw law;
  law.kind = LawKind::hertz;
  law.shear_modulus = 1e5;
  law.poisson = 0.2;
  law.ratio = 2 * 0.8 / 1.8;
  law.friction = 0.4;
  Spheres spheres = two(law);
  const double reference = spheres.forces()[1].x;
  EXPECT_NEAR(reference, 2.0 / 3 * 1e5 / 0.8 * std::sqrt(2.0) * std::pow(0.02, 1.5),
              1e-9 * reference);
  spheres.z[1] = 1.92;
  EXPECT_NEAR(spheres.forces()[1].x, 8 * reference, 1e-9 * reference);
}

// The reference packing on its way to the first increment.
Increment<3>& moved_increment(const Material<3>& material, Problem<3>& problem) {
  static Increment<3> increment;
  problem = material.problem();
  increment.begin(problem, material.initial, {1.0005, 1e-4, 0, 0, 1.0004, -2e-4, 0, 0, 0.999});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::size_t n = problem.particles();
  auto coordinates = increment.motion().coordinates();
  for (std::size_t k = 0; k < 3 * n; ++k) coordinates[k] += 2e-7 * uniform(random);
  for (std::size_t k = 3 * n; k < 6 * n; ++k) coordinates[k] = 1e-3 * uniform(random);
  increment.motion().go_to(coordinates, increment.motion().deformation());
  increment.update_forces();
  increment.refresh_masses();
  increment.update_forces();
  return increment;
}

TEST(sphere_loops, have_the_forces_of_single_contacts) {
  for (const bool turning : {true, false}) {
    const auto material = make_material<3>(turning ? describe() : locked(describe()));
    Problem<3> problem;
    auto& increment = moved_increment(*material, problem);
    std::vector<double> force(3 * increment.problem().particles(), 0.0);
    double scale = 0;
    for (std::size_t c = 0; c < increment.contacts().size(); ++c) {
      const auto point = contact_point(increment.contacts(), c, increment.motion().coordinates(),
                                       increment.problem().particles(), material->law);
      if (point.status == ContactStatus::open) continue;
      const Vec<3> f = point.force_on_j();
      scale = std::max(scale, length<3>(f));
      for (std::size_t k = 0; k < 3; ++k) {
        force[k * increment.problem().particles() +
              static_cast<std::size_t>(increment.contacts().j[c])] += f[k];
        force[k * increment.problem().particles() +
              static_cast<std::size_t>(increment.contacts().i[c])] -= f[k];
      }
    }
    for (std::size_t k = 0; k < force.size(); ++k) {
      ASSERT_NEAR(increment.residual()[k], force[k], 1e-12 * scale) << k;
    }
  }
}

// Touching contacts of every node.
std::vector<int> contacts_of_nodes(const Increment<3>& increment, const ContactLaw& law) {
  std::vector<int> count(increment.problem().nodes(), 0);
  for (std::size_t c = 0; c < increment.contacts().size(); ++c) {
    const auto point = contact_point(increment.contacts(), c, increment.motion().coordinates(),
                                     increment.problem().particles(), law);
    if (point.status == ContactStatus::open) continue;
    ++count[static_cast<std::size_t>(increment.contacts().i[c])];
    ++count[static_cast<std::size_t>(increment.contacts().j[c])];
  }
  return count;
}

// K dz against central differences of the residual along random motions, spins composed. Spheres with two
// contacts do not spin in them: K holds them, lest they spin freely about the chord.
TEST(sphere_stiffness, is_the_derivative_of_the_residual) {
  const auto material = make_material<3>(describe());
  Problem<3> problem;
  auto& increment = moved_increment(*material, problem);
  Stiffness<3> stiffness;
  const std::size_t n = increment.problem().particles();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> motion(6 * n);
  for (std::size_t k = 0; k < motion.size(); ++k) {
    motion[k] = (k < 3 * n ? increment.motion().node_radius()[k % n] : 1.0) * uniform(random);
  }
  const auto count = contacts_of_nodes(increment, material->law);
  for (std::size_t k = 3 * n; k < motion.size(); ++k) {
    if (count[k % n] == 2) motion[k] = 0;
  }
  const auto before = increment.motion().coordinates();
  std::array<std::vector<double>, 2> residual;
  constexpr double step = 1e-7;
  for (std::size_t side = 0; side < 2; ++side) {
    increment.motion().go_to(before, increment.motion().deformation());
    increment.motion().move(motion, side == 0 ? step : -step);
    increment.update_forces();
    residual[side].assign(increment.residual().begin(), increment.residual().end());
  }
  increment.motion().go_to(before, increment.motion().deformation());
  increment.update_forces();
  stiffness.assemble(increment, 0);
  double worst = 0;
  double scale = 0;
  const auto by_stiffness = stiffness.product(motion);
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const double lever = k < 3 * n ? 1.0 : increment.motion().node_radius()[k % n];
    const double difference = (residual[1][k] - residual[0][k]) / (2 * step);
    worst = std::max(worst, std::abs(by_stiffness[k] - difference) / lever);
    scale = std::max(scale, std::abs(difference) / lever);
  }
  EXPECT_LT(worst, 1e-6 * scale);
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

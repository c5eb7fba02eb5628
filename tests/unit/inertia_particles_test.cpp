// Volumes with inertia against the particles of the same cell, which other code moves.
#include "moving_cell.hpp"
#include "sphere_support.hpp"
#include "support.hpp"

#include "increment/particle_masses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainlaw::core::moving_cell {
namespace {

template <int D>
double frequency_of(const Material<D>& material) {
  const double radius = mean_radius(material.packing.radius);
  return std::sqrt(material.law.stiffness(radius, radius) /
                   particle_mass<D>(material.packing.density, radius, material.packing.thickness));
}

// Compressed along one axis by `strain` within the time 10 and then held, in units of 1 / frequency.
template <int D>
Stretch stretch_at(double time, double strain, double frequency) {
  constexpr double end = 10;
  Stretch at;
  if (time < end) {
    const double angle = std::numbers::pi * time / end;
    at.of[1] = 1 - 0.5 * strain * (1 - std::cos(angle));
    at.rate[1] = -0.5 * strain * std::sin(angle) * std::numbers::pi / end * frequency;
  } else {
    at.of[1] = 1 - strain;
  }
  return at;
}

struct Row {
  double stress, kinetic;
};

template <int D>
std::vector<Row> rows_of_particles(const Material<D>& material, double strain, int rows,
                                   int steps) {
  const double frequency = frequency_of(material);
  MovingCell<D> cell(material);
  std::vector<Row> found;
  for (int n = 0; n < rows * steps; ++n) {
    const double dt = 1.0 / steps;
    cell.step(stretch_at<D>(n * dt, strain, frequency),
              stretch_at<D>((n + 1) * dt, strain, frequency), dt / frequency);
    if ((n + 1) % steps == 0) found.push_back({cell.stress(1), cell.kinetic_energy()});
  }
  return found;
}

template <int D>
std::vector<Row> rows_of_volume(const std::shared_ptr<const Material<D>>& material, double strain,
                                int rows, int steps) {
  const double frequency = frequency_of(*material);
  State<D> state(material);
  state.set_time_step(1.0 / steps / frequency);
  std::vector<Row> found;
  for (int n = 0; n < rows * steps; ++n) {
    const Stretch at = stretch_at<D>((n + 1.0) / steps, strain, frequency);
    Tensor<D> F = identity<D>(), P{};
    F[D + 1] = at.of[1];
    grainlaw_report report{};
    EXPECT_EQ(state.evaluate(F.data(), TangentKind::none, P.data(), nullptr, report), GRAINLAW_OK)
        << report.message;
    state.commit();
    double sigma[D * D], kinetic = 0;
    const Problem<D> problem = material->problem();
    measure(problem, state.current(), GRAINLAW_CAUCHY_STRESS, sigma);
    measure(problem, state.current(), GRAINLAW_KINETIC_ENERGY, &kinetic);
    if ((n + 1) % steps == 0) found.push_back({sigma[D + 1], kinetic});
  }
  return found;
}

// Largest differences over the largest change of stress, and over the largest kinetic energy.
Row apart(const std::vector<Row>& a, const std::vector<Row>& b) {
  Row difference{0, 0}, largest{0, 0};
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference.stress = std::max(difference.stress, std::abs(a[k].stress - b[k].stress));
    difference.kinetic = std::max(difference.kinetic, std::abs(a[k].kinetic - b[k].kinetic));
    largest.stress = std::max(largest.stress, std::abs(b[k].stress - b[0].stress));
    largest.kinetic = std::max(largest.kinetic, b[k].kinetic);
  }
  return {difference.stress / largest.stress, difference.kinetic / largest.kinetic};
}

template <int D>
void expect_that_volumes_move_as_particles(MaterialDescription description, double strain) {
  description.solver.inertia = true;
  const auto material = make_material<D>(description);
  constexpr int rows = 40;
  const auto particles = rows_of_particles<D>(*material, strain, rows, 200);
  const Row coarse = apart(rows_of_volume<D>(material, strain, rows, 5), particles);
  const Row fine = apart(rows_of_volume<D>(material, strain, rows, 20), particles);
  EXPECT_LT(fine.stress, 0.01);
  EXPECT_LT(fine.kinetic, 0.02);
  EXPECT_LT(fine.stress, 0.3 * coarse.stress);
  EXPECT_GT(coarse.stress, 1e-4);
}

TEST(inertia_particles, discs_move_as_particles_do) {
  expect_that_volumes_move_as_particles<2>(test::describe(test::small_packing(), test::rough_law()),
                                           0.01);
}

TEST(inertia_particles, discs_without_friction_move_as_particles_do) {
  expect_that_volumes_move_as_particles<2>(
      test::describe(test::small_packing(), test::smooth_law()), 0.01);
}

TEST(inertia_particles, spheres_move_as_particles_do) {
  expect_that_volumes_move_as_particles<3>(sphere_test::describe(), 0.01);
}

}  // namespace
}  // namespace grainlaw::core::moving_cell

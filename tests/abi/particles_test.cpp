// Particles and contacts of a state, as arrays.
#include "support.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>

namespace grainlaw::test {
namespace {

// dim x dim, tension positive [Pa].
std::vector<double> stress_of(const State& state, std::size_t dim) {
  std::vector<double> sigma(dim * dim);
  const double volume = state.measure(GRAINLAW_VOLUME)[0];
  for (const grainlaw_contact& c : state.contacts())
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j)
        sigma[dim * i + j] -= c.weight * (c.normal_force * c.normal[i] + c.tangential_force[i]) *
                              c.branch[j] / volume;
  return sigma;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  const double size =
      std::sqrt(std::inner_product(expected.begin(), expected.end(), expected.begin(), 0.0));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-12 * size) << k;
}

double squared(const double (&v)[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

TEST(particles, contact_forces_give_the_stress_of_discs) {
  State state(material());
  stress(state, compressed);
  expect_near(stress_of(state, 2), state.measure(GRAINLAW_CAUCHY_STRESS));
}

TEST(particles, contact_forces_give_the_stress_of_spheres) {
  State state(Material::load(data_directory + "/spheres500.toml"));
  const std::array<double, 9> F{1, 1e-4, 0, 0, 1, 0, 0, 0, 0.9995};
  std::array<double, 9> P;
  ASSERT_TRUE(state.evaluate(F, P));
  expect_near(stress_of(state, 3), state.measure(GRAINLAW_CAUCHY_STRESS));
}

TEST(particles, are_those_of_the_trial_then_of_what_is_committed) {
  State state(material());
  const auto start = state.particles();
  stress(state, compressed);
  EXPECT_NE(state.particles()[0].position[1], start[0].position[1]);
  state.revert();
  EXPECT_EQ(state.particles()[0].position[1], start[0].position[1]);
}

TEST(particles, agree_with_the_measures) {
  State state(material());
  stress(state, further);
  const auto particles = state.particles();
  const auto contacts = state.contacts();
  EXPECT_EQ(particles.size(), state.measure(GRAINLAW_PARTICLES)[0]);
  EXPECT_EQ(contacts.size(), state.measure(GRAINLAW_CONTACTS)[0]);
  double spin = 0, overlap = 0;
  int ends = 0;
  for (const auto& particle : particles) {
    spin += particle.rotation[2] / static_cast<double>(particles.size());
    ends += particle.contacts;
    EXPECT_EQ(particle.position[2], 0);
    EXPECT_EQ(particle.rotation[0], 0);
  }
  EXPECT_EQ(ends, 2 * static_cast<int>(contacts.size()));
  EXPECT_NEAR(spin, state.measure(GRAINLAW_MEAN_ROTATION)[0], 1e-12);
  for (const auto& c : contacts) {
    const auto& i = particles[static_cast<std::size_t>(c.i)];
    const auto& j = particles[static_cast<std::size_t>(c.j)];
    overlap += c.overlap / static_cast<double>(contacts.size());
    EXPECT_NEAR(squared(c.normal), 1, 1e-12);
    EXPECT_NEAR(std::sqrt(squared(c.branch)), i.radius + j.radius - c.overlap, 1e-15);
    EXPECT_NEAR(c.normal[0] * c.tangential_force[0] + c.normal[1] * c.tangential_force[1], 0,
                1e-12 * c.normal_force);
    // Without a shift the branch joins the two centres.
    if (c.shift[0] == 0 && c.shift[1] == 0) {
      EXPECT_NEAR(c.branch[0], j.position[0] - i.position[0], 1e-15);
      EXPECT_NEAR(c.branch[1], j.position[1] - i.position[1], 1e-15);
    }
  }
  EXPECT_NEAR(overlap, state.measure(GRAINLAW_MEAN_OVERLAP)[0], 1e-12 * overlap);
}

TEST(particles, friction_bounds_forces_and_marks_what_slides) {
  State state(material());
  Tensor P{};
  const Evaluation found = state.evaluate(further, P);
  ASSERT_TRUE(found);
  constexpr double friction = 0.5463024898437905;  // of rve400.toml
  int sliding = 0;
  for (const auto& c : state.contacts()) {
    const double ratio = std::sqrt(squared(c.tangential_force)) / c.normal_force;
    EXPECT_LE(ratio, friction * (1 + 1e-9));
    if (c.sliding != 0) {
      EXPECT_NEAR(ratio, friction, 1e-6);
    }
    sliding += c.sliding;
  }
  EXPECT_EQ(sliding, found.report.sliding);
  EXPECT_GT(sliding, 0);
}

TEST(bad_lists, are_refused_and_nothing_is_written) {
  State state(material());
  auto particles = state.particles();
  auto contacts = state.contacts();
  constexpr std::size_t size = sizeof(grainlaw_particle), of_contact = sizeof(grainlaw_contact);
  std::size_t count = particles.size();
  expect_refused(grainlaw_state_particles(nullptr, particles.data(), size, &count),
                 GRAINLAW_NULL_POINTER, "particles state");
  expect_refused(grainlaw_state_particles(state.get(), particles.data(), size, nullptr),
                 GRAINLAW_NULL_POINTER, "particles count");
  expect_refused(grainlaw_state_contacts(nullptr, contacts.data(), of_contact, &count),
                 GRAINLAW_NULL_POINTER, "contacts state");
  expect_refused(grainlaw_state_contacts(state.get(), contacts.data(), of_contact, nullptr),
                 GRAINLAW_NULL_POINTER, "contacts count");
  auto* const material_handle =
      reinterpret_cast<grainlaw_state*>(const_cast<grainlaw_material*>(material().get()));
  expect_refused(grainlaw_state_particles(material_handle, particles.data(), size, &count),
                 GRAINLAW_BAD_HANDLE, "particles of a material");
  for (const std::size_t wrong : {std::size_t{0}, std::size_t{8}, size + 1, SIZE_MAX})
    expect_refused(grainlaw_state_particles(state.get(), particles.data(), wrong, &count),
                   GRAINLAW_BAD_ARGUMENT, "size " + std::to_string(wrong));
  for (const std::size_t wrong : {size, of_contact + 1})
    expect_refused(grainlaw_state_contacts(state.get(), contacts.data(), wrong, &count),
                   GRAINLAW_BAD_ARGUMENT, "size " + std::to_string(wrong));
  count = particles.size() - 1;
  particles[0].radius = 7;
  expect_refused(grainlaw_state_particles(state.get(), particles.data(), size, &count),
                 GRAINLAW_BUFFER_TOO_SMALL, "short");
  EXPECT_EQ(count, particles.size() - 1);
  EXPECT_EQ(particles[0].radius, 7);
}

}  // namespace
}  // namespace grainlaw::test

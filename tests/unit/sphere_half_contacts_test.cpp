// Contacts of spheres seen from their nodes: the forces of the law at a place and around it, and steps that they drive.
#include "contact/half_contacts.hpp"
#include "increment/increment.hpp"
#include "sphere_support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

namespace grainlaw::core::sphere_test {
namespace {

constexpr double gain = 1e-3;
constexpr std::size_t components = HalfContacts<3>::components;

MaterialDescription rough() { return describe(); }

// An increment at its affine start, turned a little, seen from there.
struct Scene {
  explicit Scene(const MaterialDescription& description, double stiffness = 0)
      : material(make_material<3>(description)), problem(material->problem()) {
    increment.begin(problem, material->initial, {1.0004, 2e-4, 0, 0, 1.0002, 1e-4, 0, 0, 0.999});
    for (std::size_t p = 0; description.law.rotation && p < problem.particles(); ++p) {
      for (std::size_t k = 3; k < components; ++k) {
        increment.motion().coordinate(k, p) = 1e-4 * std::sin(static_cast<double>(7 * k + p));
      }
    }
    increment.refresh_masses();
    if (stiffness > 0) {
      increment.find_first_drag(false);
      DragStart<3> how;
      how.stiffness = stiffness;
      increment.begin_drag(how, {}, true);
    }
    contacts = increment.contacts();
    arrange(true);
    totals = relinearise();
  }

  void arrange(bool at_rest) {
    half_contacts.arrange(contacts, material->packing, increment.masses().least(), records(),
                          at_rest, true);
  }

  ContactTotals relinearise() {
    const auto seen =
        half_contacts.relinearise(records(), material->law, tuned::mass_factor, contacts);
    const auto& drag = increment.motion().drag();
    if (drag.acts()) half_contacts.add_drag(records(), drag.of_nodes(), tuned::mass_factor);
    return seen;
  }

  [[nodiscard]] std::span<ParticleRecord<3>> records() { return increment.motion().records(); }
  [[nodiscard]] std::vector<ParticleRecord<3>> places() {
    return {records().begin(), records().end()};
  }

  // Residual by the law where the records are.
  [[nodiscard]] std::vector<ForceRecord<3>> residual() {
    std::vector<ForceRecord<3>> result(problem.nodes());
    evaluate_contacts<3>(records(), material->law, contacts, result);
    if (increment.motion().drag().acts()) {
      increment.motion().drag().subtract_from(result, records());
    }
    return result;
  }

  // Residual r by a step from rest, which moves particles by gain r / m.
  [[nodiscard]] std::vector<ForceRecord<3>> step() {
    increment.sum_masses();
    auto before = places();
    half_contacts.displace(before);
    measured = half_contacts.step(material->law, 0, gain);
    auto after = places();
    half_contacts.displace(after);
    std::vector<ForceRecord<3>> result(problem.nodes());
    for (std::size_t p = 0; p < result.size(); ++p) {
      for (std::size_t c = 0; c < components; ++c) {
        component(result[p], c) = (component(after[p], c) - component(before[p], c)) *
                                  (&increment.masses().records()[p].x)[c] / gain;
      }
    }
    return result;
  }

  std::shared_ptr<const Material<3>> material;
  Problem<3> problem;
  Increment<3> increment;
  ContactList<3> contacts;
  HalfContacts<3> half_contacts;
  ContactTotals totals{};
  StepMeasures measured{};
};

double largest_difference(const std::vector<ForceRecord<3>>& a,
                          const std::vector<ForceRecord<3>>& b) {
  double result = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    for (std::size_t c = 0; c < components; ++c) {
      result = std::max(result, std::abs(component(a[p], c) - component(b[p], c)));
    }
  }
  return result;
}

TEST(sphere_half_contacts, carry_the_forces_of_the_law_at_their_place) {
  for (const auto& description : {rough(), locked(rough())}) {
    for (const double stiffness : {0.0, 1e4}) {
      Scene scene(description, stiffness);
      const auto expected = scene.residual();
      const double force = scene.totals.force / scene.totals.weights;
      EXPECT_LE(largest_difference(scene.step(), expected), 1e-7 * force);
      double largest = 0;
      for (const auto& r : expected) {
        for (std::size_t c = 0; c < components; ++c)
          largest = std::max(largest, std::abs(component(r, c)));
      }
      EXPECT_NEAR(scene.measured.largest, largest, 1e-10 * force);
      EXPECT_EQ(scene.totals.touching, scene.increment.scale().touching());
      EXPECT_NEAR(force, scene.increment.scale().mean_force(), 1e-12 * force);
    }
  }
}

// The normals stay: of a change that is about kn u, overlap / branch kn u is of it.
TEST(sphere_half_contacts, follow_the_law_to_first_order_of_the_moves) {
  for (const auto& description : {rough(), locked(rough())}) {
    Scene scene(description);
    const auto at_place = scene.step();
    auto there = scene.places();
    scene.half_contacts.displace(there);
    const auto changed = scene.step();
    std::copy(there.begin(), there.end(), scene.records().begin());
    const double change = largest_difference(changed, at_place);
    EXPECT_GT(change, 0);
    EXPECT_LE(largest_difference(changed, scene.residual()), 1e-2 * change);
  }
}

TEST(sphere_half_contacts, give_every_particle_its_force_in_whatever_order_they_lie) {
  Scene scene(rough());
  const auto expected = scene.step();
  Packing reversed = scene.material->packing;
  reversed.order.clear();
  for (std::size_t p = reversed.size(); p > 0; --p) {
    reversed.order.push_back(static_cast<std::int32_t>(p - 1));
  }
  scene.half_contacts.arrange(scene.contacts, reversed, scene.increment.masses().least(),
                              scene.records(), true, false);
  scene.relinearise();
  EXPECT_EQ(largest_difference(scene.step(), expected), 0);
}

// Places after steps, a new list or a change of precision, and another step.
enum class Between { nothing, new_list, precisions };
std::vector<std::array<double, components>> moved(Between between, bool single = false) {
  Scene scene(rough());
  scene.half_contacts.step_in_single_precision(single);
  scene.relinearise();
  const auto& law = scene.material->law;
  for (int k = 0; k < 5; ++k) scene.half_contacts.step(law, 0.9, gain);
  scene.half_contacts.displace(scene.records());
  if (between == Between::new_list) scene.arrange(false);
  if (between == Between::precisions) scene.half_contacts.step_in_single_precision(!single);
  scene.relinearise();
  scene.half_contacts.step(law, 0.9, gain);
  scene.half_contacts.displace(scene.records());
  std::vector<std::array<double, components>> places;
  for (const auto& at : scene.records()) {
    auto& place = places.emplace_back();
    std::copy_n(&at.x, components, place.begin());
  }
  return places;
}

TEST(sphere_half_contacts, keep_their_velocities_in_a_new_list) {
  for (const bool single : {false, true}) {
    EXPECT_EQ(moved(Between::new_list, single), moved(Between::nothing, single));
  }
}

TEST(sphere_half_contacts, keep_their_velocities_when_the_precision_changes) {
  const auto start = Scene(rough()).places();
  const auto expected = moved(Between::nothing);
  double largest = 0;
  for (std::size_t p = 0; p < expected.size(); ++p) {
    for (std::size_t c = 0; c < components; ++c) {
      largest = std::max(largest, std::abs(expected[p][c] - component(start[p], c)));
    }
  }
  for (const bool single : {false, true}) {
    const auto found = moved(Between::precisions, single);
    for (std::size_t p = 0; p < expected.size(); ++p) {
      for (std::size_t c = 0; c < components; ++c) {
        EXPECT_NEAR(found[p][c], expected[p][c], 1e-5 * largest);
      }
    }
  }
}

// Single precision has units of the packing, so that neither large nor small numbers are lost.
TEST(sphere_half_contacts, have_nearly_the_forces_of_the_law_in_single_precision) {
  for (const auto& description : {rough(), locked(rough())}) {
    for (const double stiffness : {0.0, 1e4}) {
      Scene scene(description, stiffness);
      const auto expected = scene.residual();
      scene.half_contacts.step_in_single_precision(true);
      scene.relinearise();
      const double force = scene.totals.force / scene.totals.weights;
      EXPECT_LE(largest_difference(scene.step(), expected), 1e-5 * force);
      EXPECT_GT(largest_difference(scene.step(), expected), 0);
    }
  }
}

}  // namespace
}  // namespace grainlaw::core::sphere_test

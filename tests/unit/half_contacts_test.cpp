// Contacts seen from their nodes: the forces of the law at a place and around it, and steps that they
// drive.
#include "contact/half_contacts.hpp"
#include "increment/increment.hpp"
#include "law_support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr double gain = 1e-3;

// An increment at its affine start, seen from there.
struct Scene {
  explicit Scene(const Packing& packing, const ContactLaw& law, const Tensor& F)
      : material(make_material(describe(packing, law, BoundaryType::periodic_cell))),
        problem(material->problem()) {
    increment.begin(problem, material->initial, F);
    increment.refresh_masses();
    contacts = increment.contacts();
    arrange(true);
    totals = relinearise();
  }

  void arrange(bool at_rest) {
    half_contacts.arrange(contacts, material->packing, increment.masses().least(), records(),
                          at_rest, true);
  }

  ContactTotals relinearise() {
    return half_contacts.relinearise(records(), material->law, tuned::mass_factor, contacts);
  }

  [[nodiscard]] std::span<ParticleRecord> records() { return increment.motion().records(); }
  [[nodiscard]] std::vector<ParticleRecord> places() {
    return {records().begin(), records().end()};
  }

  // Residual by the law where the records are.
  [[nodiscard]] std::vector<ForceRecord> residual() {
    std::vector<ForceRecord> result(problem.nodes());
    evaluate_contacts<2>(records(), material->law, contacts, result);
    return result;
  }

  // Residual r by a step from rest, which moves particles by gain r / m.
  [[nodiscard]] std::vector<ForceRecord> step() {
    auto before = places();
    half_contacts.displace(before);
    measured = half_contacts.step(material->law, 0, gain);
    auto after = places();
    half_contacts.displace(after);
    std::vector<ForceRecord> result(problem.nodes());
    for (std::size_t p = 0; p < result.size(); ++p) {
      const auto& m = increment.masses().records()[p];
      result[p] = {(after[p].x - before[p].x) * m.x / gain, (after[p].y - before[p].y) * m.y / gain,
                   (after[p].roll - before[p].roll) * m.roll / gain};
    }
    return result;
  }

  std::shared_ptr<const Material> material;
  Problem problem;
  Increment increment;
  ContactList contacts;
  HalfContacts half_contacts;
  ContactTotals totals{};
  StepMeasures measured{};
};

double largest(const ForceRecord& a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.roll)});
}

double largest(const std::vector<ForceRecord>& values) {
  double result = 0;
  for (const auto& value : values) result = std::max(result, largest(value));
  return result;
}

double largest_difference(const std::vector<ForceRecord>& a, const std::vector<ForceRecord>& b) {
  double result = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    result = std::max(result, largest({a[p].x - b[p].x, a[p].y - b[p].y, a[p].roll - b[p].roll}));
  }
  return result;
}

std::vector<ContactLaw> laws() {
  ContactLaw locked = rough_law();
  locked.rotation = false;
  return {rough_law(), locked};
}

// The last one turns branches by more than the short series is for.
const std::vector<Tensor> deformations{{1.0004, 0, 0, 0.999}, {1, 3e-3, 1e-3, 1}, {1, 0.4, 0, 1}};

TEST(half_contacts, carry_the_forces_of_the_law_at_their_place) {
  for (const std::size_t count : {2U, 3U, 21U, 80U}) {  // of the last group of eight a part, too
    for (const auto& law : laws()) {
      for (const Tensor& F : deformations) {
        Scene scene(small_packing(count), law, F);
        const auto expected = scene.residual();
        const double force = scene.totals.force / scene.totals.weights;
        EXPECT_LE(largest_difference(scene.step(), expected), 1e-8 * force) << count;
        EXPECT_NEAR(scene.measured.largest, largest(expected), 1e-10 * force) << count;
        EXPECT_EQ(scene.totals.touching, scene.increment.scale().touching());
        EXPECT_NEAR(force, scene.increment.scale().mean_force(), 1e-12 * force);
      }
    }
  }
}

// Half contacts rotate every normal by the mean branch. A force change of about kn u is then wrong
// by about kn u x overlap / branch.
TEST(half_contacts, follow_the_law_to_first_order_of_the_moves) {
  for (const auto& law : laws()) {
    Scene scene(small_packing(), law, {1.0004, 2e-4, 0, 0.999});
    const auto at_place = scene.step();
    auto there = scene.places();
    scene.half_contacts.displace(there);
    const auto changed = scene.step();
    std::copy(there.begin(), there.end(), scene.records().begin());
    const double change = largest_difference(changed, at_place);
    EXPECT_GT(change, 0);
    EXPECT_LE(largest_difference(changed, scene.residual()), 4e-3 * change);
  }
}

TEST(half_contacts, give_every_particle_its_force_in_whatever_order_they_lie) {
  Scene scene(small_packing(), rough_law(), {1.0004, 2e-4, 0, 0.999});
  const auto expected = scene.step();
  Packing reversed = scene.material->packing;
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
std::vector<std::array<double, 3>> moved(Between between, bool single) {
  Scene scene(small_packing(), rough_law(), {1.0004, 2e-4, 0, 0.999});
  const auto& law = scene.material->law;
  scene.half_contacts.step_in_single_precision(single);
  scene.relinearise();
  for (int k = 0; k < 5; ++k) scene.half_contacts.step(law, 0.9, gain);
  scene.half_contacts.displace(scene.records());
  if (between == Between::new_list) scene.arrange(false);
  if (between == Between::precisions) scene.half_contacts.step_in_single_precision(!single);
  scene.relinearise();
  scene.half_contacts.step(law, 0.9, gain);
  scene.half_contacts.displace(scene.records());
  std::vector<std::array<double, 3>> places;
  for (const auto& at : scene.records()) places.push_back({at.x, at.y, at.roll});
  return places;
}

double largest_difference(const std::vector<std::array<double, 3>>& a,
                          const std::vector<std::array<double, 3>>& b) {
  double result = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    for (std::size_t c = 0; c < 3; ++c) result = std::max(result, std::abs(a[p][c] - b[p][c]));
  }
  return result;
}

TEST(half_contacts, keep_their_velocities_in_a_new_list) {
  for (const bool single : {false, true}) {
    EXPECT_EQ(moved(Between::new_list, single), moved(Between::nothing, single));
  }
}

TEST(half_contacts, keep_their_velocities_when_the_precision_changes) {
  std::vector<std::array<double, 3>> start;
  Scene scene(small_packing(), rough_law(), {1.0004, 2e-4, 0, 0.999});
  for (const auto& at : scene.records()) start.push_back({at.x, at.y, at.roll});
  const auto expected = moved(Between::nothing, false);
  const double move = largest_difference(expected, start);
  EXPECT_GT(move, 0);
  for (const bool single : {false, true}) {
    EXPECT_LE(largest_difference(moved(Between::precisions, single), expected), 1e-5 * move);
  }
}

TEST(half_contacts, have_nearly_the_forces_of_the_law_in_single_precision) {
  for (const auto& law : laws()) {
    Scene scene(small_packing(), law, {1.0004, 2e-4, 0, 0.999});
    const auto expected = scene.residual();
    scene.half_contacts.step_in_single_precision(true);
    scene.relinearise();
    const double force = scene.totals.force / scene.totals.weights;
    EXPECT_LE(largest_difference(scene.step(), expected), 1e-5 * force);
    EXPECT_GT(largest_difference(scene.step(), expected), 0);
  }
}

}  // namespace
}  // namespace grainlaw::core::test

// Saved states whose checksum is right but whose content is not: only the checks of the content
// help.
#include "plane.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace grainlaw::core::test {
namespace {

// Three particles that rotate, as far as saved states are concerned.
Material small_material() {
  Material material;
  material.packing.radius = {1, 1, 1};
  material.initial.coordinates.assign(9, 0.5);
  material.fingerprint = 42;
  return material;
}

Configuration small_configuration() {
  Configuration configuration;
  configuration.deformation = {1, 0.25, 0, 1};
  configuration.stress = {-1, 2, 3, -4};
  configuration.coordinates = {0, 1, 2, 3, -4, 5, 6, 1e-300, -0.0};
  configuration.contacts = {{0, 0, {0, 1}, false, false, {3.5}},
                            {0, 1, {-1, 0}, true, false, {-2}},
                            {0, 1, {0, 0}, false, false, {0}},
                            {1, 2, {0, 0}, true, false, {1}}};
  configuration.dissipated = 7;
  return configuration;
}

std::vector<std::byte> save(const Configuration& configuration) {
  const Material material = small_material();
  std::vector<std::byte> bytes(saved_size(material, configuration));
  save_configuration(material, configuration, bytes);
  return bytes;
}

void seal(std::vector<std::byte>& bytes) {
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), bytes.size() - 8);
  for (std::size_t k = 0; k < 8; ++k)
    bytes[bytes.size() - 8 + k] = static_cast<std::byte>(checksum >> (8 * k));
}

grainlaw_status status_of(const std::vector<std::byte>& bytes,
                          const Material& material = small_material()) {
  try {
    (void)load_configuration(material, bytes);
    return GRAINLAW_OK;
  } catch (const Error& error) {
    return error.status;
  }
}

// Loading what was saved from a configuration that cannot be.
grainlaw_status status_after(void (*change)(Configuration&)) {
  Configuration configuration = small_configuration();
  change(configuration);
  return status_of(save(configuration));
}

TEST(serialise, round_trip_keeps_every_bit) {
  const auto bytes = save(small_configuration());
  const Configuration loaded = load_configuration(small_material(), bytes).committed;
  EXPECT_EQ(save(loaded), bytes);
  EXPECT_TRUE(std::signbit(loaded.coordinates[8]));
  EXPECT_EQ(loaded.contacts[1].shift[0], -1);
  EXPECT_TRUE(loaded.contacts[1].sliding);
  EXPECT_EQ(loaded.contacts[1].tangential_force[0], -2);
  EXPECT_EQ(loaded.stress, small_configuration().stress);
  EXPECT_EQ(loaded.dissipated, 7);
}

TEST(serialise, bytes_are_little_endian_on_every_machine) {
  const auto bytes = save(small_configuration());
  EXPECT_EQ(std::memcmp(bytes.data(), "GRAINLAW\2\0\0\0\4\0\0\0\52\0\0\0\0\0\0\0", 24), 0);
  EXPECT_EQ(bytes.size(), 24U + 8 * (4 + 4 + 1 + 9) + 4 * 21 + 8);
}

TEST(serialise, another_version_is_told_from_damage) {
  auto bytes = save(small_configuration());
  bytes[8] = std::byte{3};
  EXPECT_EQ(status_of(bytes), GRAINLAW_BAD_BYTES);
  seal(bytes);
  EXPECT_EQ(status_of(bytes), GRAINLAW_WRONG_VERSION);
}

TEST(serialise, a_time_step_is_kept_with_drag) {
  Material material = small_material();
  const std::size_t without = saved_size(material, small_configuration());
  material.solver.viscosity.number = 1e-3;
  std::vector<std::byte> bytes(saved_size(material, small_configuration()));
  EXPECT_EQ(bytes.size(), without + 8 * (4 + 9) + 8);
  for (const double told : {untold, 0.0, 1e-300, 0.25}) {
    save_configuration(material, small_configuration(), bytes, told);
    EXPECT_EQ(std::memcmp(bytes.data(), "GRAINLAW\4\0\0\0", 12), 0);
    EXPECT_EQ(load_configuration(material, bytes).time_step, told);
  }
  for (const double wrong : {-0.5, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    save_configuration(material, small_configuration(), bytes, wrong);
    EXPECT_EQ(status_of(bytes, material), GRAINLAW_BAD_BYTES) << wrong;
  }
}

TEST(serialise, a_reference_is_kept_and_is_another_version) {
  Material material = small_material();
  for (const double number : {0.0, 1e-3}) {
    material.solver.viscosity.number = number;
    const std::optional reference = Reference<2>({0.99, 0.01, 0, 0.98});
    const auto small = small_configuration();
    std::vector<std::byte> bytes(saved_size(material, small, reference));
    EXPECT_EQ(bytes.size(), saved_size(material, small) + 8 * 4);
    save_configuration(material, small, bytes, untold, reference);
    EXPECT_EQ(bytes[8],
              static_cast<std::byte>(number > 0 ? 6 : 5));  // above what older libraries read
    const auto loaded = load_configuration(material, bytes).reference;
    ASSERT_TRUE(loaded.has_value());
    EXPECT_EQ(loaded->deformation(), reference->deformation());
    bytes[bytes.size() - 10] ^= std::byte{1};
    EXPECT_EQ(status_of(bytes, material), GRAINLAW_BAD_BYTES);
    save_configuration(material, small, bytes, untold, std::optional(Reference<2>({0, 1, 1, 0})));
    EXPECT_EQ(status_of(bytes, material), GRAINLAW_BAD_BYTES);
  }
}

TEST(serialise, drag_of_another_law_is_another_version) {
  Material material = small_material();
  std::vector<std::byte> without = save(small_configuration());
  material.solver.viscosity.number = 1e-3;
  EXPECT_EQ(status_of(without, material), GRAINLAW_WRONG_VERSION);
  std::vector<std::byte> bytes(saved_size(material, small_configuration()));
  save_configuration(material, small_configuration(), bytes);
  EXPECT_EQ(status_of(bytes), GRAINLAW_WRONG_VERSION);
  bytes[8] = std::byte{3};
  seal(bytes);
  EXPECT_EQ(status_of(bytes, material), GRAINLAW_WRONG_VERSION);
}

TEST(serialise, another_material_is_told) {
  Material other = small_material();
  other.fingerprint = 43;
  EXPECT_EQ(status_of(save(small_configuration()), other), GRAINLAW_WRONG_MATERIAL);
}

TEST(serialise, a_sealed_state_that_cannot_be_is_refused) {
  constexpr auto bad = GRAINLAW_BAD_BYTES;
  EXPECT_EQ(status_after([](auto&) {}), GRAINLAW_OK);
  EXPECT_EQ(status_after([](auto& c) { c.deformation[0] = 0; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.deformation[3] = -1; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.deformation[1] = NAN; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.stress[2] = NAN; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.dissipated = INFINITY; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.coordinates[8] = -INFINITY; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[3].j = 3; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[3].i = -1; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[3].i = 3; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[0].shift = {0, 0}; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[0].shift = {0, -1}; }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[2].shift = {-1, 0}; }), bad);  // twice
  EXPECT_EQ(status_after([](auto& c) { std::swap(c.contacts[1], c.contacts[2]); }), bad);
  EXPECT_EQ(status_after([](auto& c) { c.contacts[2].tangential_force[0] = NAN; }), bad);
}

TEST(serialise, a_sealed_count_that_does_not_fit_is_refused) {
  const auto good = save(small_configuration());
  for (const unsigned count : {0U, 3U, 5U, 255U}) {
    auto bytes = good;
    bytes[12] = static_cast<std::byte>(count);
    seal(bytes);
    EXPECT_EQ(status_of(bytes), GRAINLAW_BAD_BYTES) << count;
  }
  auto bytes = good;
  for (std::size_t k = 12; k < 16; ++k) bytes[k] = std::byte{255};
  seal(bytes);
  EXPECT_EQ(status_of(bytes), GRAINLAW_BAD_BYTES);
  for (std::size_t size = 20; size < good.size(); ++size) {
    auto cut = std::vector(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    seal(cut);
    EXPECT_EQ(status_of(cut), GRAINLAW_BAD_BYTES) << size;
  }
}

TEST(serialise, a_sealed_flag_that_is_neither_true_nor_false_is_refused) {
  auto bytes = save(small_configuration());
  bytes[24 + 8 * 18 + 12] = std::byte{2};  // of the first contact
  seal(bytes);
  EXPECT_EQ(status_of(bytes), GRAINLAW_BAD_BYTES);
}

}  // namespace
}  // namespace grainlaw::core::test

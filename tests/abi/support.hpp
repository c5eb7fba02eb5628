// What the tests through the C ABI share: the small packing, its material, and bits to compare.
#pragma once

#include "../data.hpp"
#include "../temporary_directory.hpp"

#include <grainlaw/grainlaw.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace grainlaw::test {

using grainlaw::Material;
using grainlaw::State;
using Tensor = std::array<double, 4>;
using Tangent = std::array<double, 16>;

inline const std::string data_directory = grainlaw::test::data_folder();
inline const std::string material_path = data_directory + "/rve400.toml";

// 400 discs at 100 kPa; loaded once, as it never changes.
inline const Material& material() {
  static const Material instance = Material::load(material_path);
  return instance;
}

inline constexpr Tensor identity{1, 0, 0, 1};
inline constexpr Tensor compressed{1.0002, 1e-4, -2e-4, 0.999};
inline constexpr Tensor further{1.0004, 3e-4, -1e-4, 0.998};

template <class Array>
bool same_bits(const Array& a, const Array& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

// Stress at F, which must be found.
inline Tensor stress(State& state, const Tensor& F) {
  Tensor P{};
  EXPECT_TRUE(state.evaluate(F, P));
  return P;
}

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// Inputs that were wrong on purpose; printed at the end.
inline long bad_inputs = 0;

// One wrong call: counts it and expects its documented status.
inline void expect_refused(grainlaw_status found, grainlaw_status expected,
                           const std::string& what) {
  ++bad_inputs;
  EXPECT_EQ(found, expected) << what << ": " << grainlaw_status_text(found);
}

}  // namespace grainlaw::test

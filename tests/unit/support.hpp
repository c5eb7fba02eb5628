// What the tests of the mechanics share: packings, materials, and increments from state to state.
#pragma once

#include "../data.hpp"
#include "frame/frame.hpp"
#include "generate/compaction.hpp"
#include "homogenise/measures.hpp"
#include "material/material.hpp"
#include "material/packing_file.hpp"
#include "norms.hpp"
#include "plane.hpp"
#include "state/state.hpp"

#include <grainlaw/grainlaw.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace grainlaw::core::test {

using Tensor = std::array<double, 4>;
using Tangent = std::array<double, 16>;

inline constexpr Tensor identity{1, 0, 0, 1};

inline Tensor product(const Tensor& a, const Tensor& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

inline Tensor transpose(const Tensor& a) { return {a[0], a[2], a[1], a[3]}; }

inline Tensor rotation(double angle) {
  return {std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
}

template <std::size_t size>
std::array<double, size> sum(const std::array<double, size>& a, double factor,
                             const std::array<double, size>& b) {
  std::array<double, size> result = a;
  for (std::size_t k = 0; k < size; ++k) result[k] += factor * b[k];
  return result;
}

inline double dot(const Tensor& a, const Tensor& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

// The law of the reference packing.
inline ContactLaw rough_law() {
  ContactLaw law;
  law.young = 6e8;
  law.ratio = 0.8;
  law.friction = std::tan(0.5);
  return law;
}

inline ContactLaw smooth_law() {
  ContactLaw law = rough_law();
  law.friction = 0;
  return law;
}

inline ContactLaw locked_law() {
  ContactLaw law = rough_law();
  law.rotation = false;
  return law;
}

// 400 discs at 100 kPa, tests/data.
inline const Packing& reference_packing() {
  static const Packing packing = [] {
    const std::string data = grainlaw::test::data_file("rve400_");
    return read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"});
  }();
  return packing;
}

// Generated discs at 100 kPa; made once per size and seed.
inline const Packing& small_packing(std::size_t count = 80, std::uint64_t seed = 1) {
  static std::map<std::pair<std::size_t, std::uint64_t>, Packing> made;
  const auto [place, is_new] = made.try_emplace({count, seed});
  if (is_new) {
    GeneratorOptions options;
    options.count = count;
    options.seed = seed;
    place->second = consolidate(options, smooth_law());
  }
  return place->second;
}

// The packing without its rattlers, discs that are in no contact. Where they end is not determined,
// and what rounding decides decides more once one of them comes to bear.
inline Packing without_rattlers(const Packing& packing) {
  std::vector<int> place(packing.size(), -1);
  for (const auto& contact : packing.contacts) {
    place[static_cast<std::size_t>(contact.i)] = place[static_cast<std::size_t>(contact.j)] = 0;
  }
  Packing held = packing;
  held.radius.clear();
  held.position.clear();
  int count = 0;
  for (std::size_t p = 0; p < packing.size(); ++p) {
    if (place[p] < 0) continue;
    place[p] = count++;
    held.radius.push_back(packing.radius[p]);
  }
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t p = 0; p < packing.size(); ++p) {
      if (place[p] >= 0) held.position.push_back(packing.position[c * packing.size() + p]);
    }
  }
  for (auto& contact : held.contacts) {
    contact.i = place[static_cast<std::size_t>(contact.i)];
    contact.j = place[static_cast<std::size_t>(contact.j)];
  }
  return held;
}

inline MaterialDescription describe(const Packing& packing, const ContactLaw& law,
                                    BoundaryType boundary = BoundaryType::periodic_cell,
                                    double tolerance = 1e-10) {
  MaterialDescription description;
  description.packing = packing;
  // Forces along the tangent belong to a law that has them.
  if (!law.tangential()) {
    for (auto& contact : description.packing.contacts) contact.tangential_force = {};
  }
  description.law = law;
  description.boundary.type = boundary;
  description.solver.tolerance = tolerance;
  return description;
}

struct Evaluation {
  grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
  Tensor stress{};
  Tangent tangent{};
  grainlaw_report report{};
};

inline Evaluation evaluate(State& state, const Tensor& F, TangentKind kind = TangentKind::none) {
  Evaluation result;
  result.status =
      state.evaluate(F.data(), kind, result.stress.data(), result.tangent.data(), result.report);
  return result;
}

// Evaluate and commit; both have to succeed.
inline Evaluation advance(State& state, const Tensor& F) {
  const Evaluation result = evaluate(state, F);
  EXPECT_EQ(result.status, GRAINLAW_OK) << result.report.message;
  EXPECT_TRUE(state.commit());
  return result;
}

// Go to F in equal steps.
inline void advance(State& state, const Tensor& F, int steps) {
  const auto& f0 = state.committed().deformation;
  const Tensor start{f0[0], f0[1], f0[2], f0[3]};
  for (int k = 1; k <= steps; ++k) {
    advance(state, sum(start, static_cast<double>(k) / steps, sum(F, -1, start)));
  }
}

inline double measure(const State& state, grainlaw_measure what) {
  double value = 0;
  measure(state.material().problem(), state.current(), what, &value);
  return value;
}

inline int sliding_contacts(const Configuration& configuration) {
  int count = 0;
  for (const auto& contact : configuration.contacts) count += contact.sliding ? 1 : 0;
  return count;
}

inline bool same_bits(const Configuration& a, const Configuration& b) {
  const auto same_contact = [](const ContactHistory& c, const ContactHistory& d) {
    return c.i == d.i && c.j == d.j && c.shift == d.shift && c.sliding == d.sliding &&
           c.tangential_force == d.tangential_force;
  };
  return a.deformation == b.deformation && a.coordinates == b.coordinates && a.stress == b.stress &&
         a.dissipated == b.dissipated &&
         std::equal(a.contacts.begin(), a.contacts.end(), b.contacts.begin(), b.contacts.end(),
                    same_contact);
}

// Contacts that carry something, and whether their forces are at the friction limit. Contacts of
// rattlers carry next to nothing and come and go with the solver's tolerance.
using BearingContact = std::tuple<int, int, std::array<int, 2>, bool>;

inline std::vector<BearingContact> bearing_contacts(const State& state) {
  constexpr double least = 1e-5;     // of the mean normal force
  constexpr double rounding = 1e-6;  // of the friction limit of the weakest of them
  const auto views = contact_views(state.material().problem(), state.current());
  double mean = 0;
  for (const auto& view : views) mean += view.normal_force / static_cast<double>(views.size());
  std::vector<BearingContact> result;
  for (const auto& view : views) {
    if (view.normal_force < least * mean) continue;
    const double limit = state.material().law.friction * view.normal_force;
    const bool sliding = std::abs(view.tangential_force[0]) > (1 - rounding) * limit;
    result.emplace_back(view.i, view.j, view.shift, sliding);
  }
  return result;
}

}  // namespace grainlaw::core::test

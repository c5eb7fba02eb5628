// A set with the points of a batch, and what it found.
#pragma once

#include "batch_support.hpp"

namespace grainlaw::test {

using grainlaw::Points;

inline Points make_set() { return {material(), points}; }

inline Result evaluate(Points& set, int threads) {
  Result found;
  EXPECT_TRUE(set.evaluate(deformations(), found.P, GRAINLAW_WANT_TANGENT_EXACT, found.A, threads,
                           found.status, found.report));
  return found;
}

struct Summarised {
  std::vector<double> P = std::vector<double>(4 * points);
  grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
  grainlaw_summary summary = grainlaw_summary_default();
};

inline Summarised evaluate_at(Points& set, const std::vector<double>& F, int threads) {
  Summarised found;
  found.status = grainlaw_points_evaluate(set.get(), F.data(), 0, found.P.data(), nullptr, nullptr,
                                          nullptr, threads, &found.summary);
  return found;
}

inline std::vector<std::byte> save_one(const grainlaw_state* state) {
  std::size_t size = 0;
  EXPECT_EQ(grainlaw_state_save(state, nullptr, &size), GRAINLAW_OK);
  std::vector<std::byte> bytes(size);
  EXPECT_EQ(grainlaw_state_save(state, bytes.data(), &size), GRAINLAW_OK);
  return bytes;
}

inline std::vector<double> measure_one(const grainlaw_state* state, grainlaw_measure what) {
  std::size_t count = 0;
  EXPECT_EQ(grainlaw_state_measure(state, what, nullptr, &count), GRAINLAW_OK);
  std::vector<double> value(count);
  EXPECT_EQ(grainlaw_state_measure(state, what, value.data(), &count), GRAINLAW_OK);
  return value;
}

}  // namespace grainlaw::test

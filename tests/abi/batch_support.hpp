// A batch of points at different strains, some cheap, some dear, and what it found.
#pragma once

#include "support.hpp"

namespace grainlaw::test {

inline constexpr std::size_t points = 8;

inline std::vector<double> deformations() {
  std::vector<double> F;
  for (std::size_t k = 0; k < points; ++k) {
    const double strain = 2e-4 * static_cast<double>((3 * k) % points);
    F.insert(F.end(), {1, strain, 0, 1 - strain});
  }
  return F;
}

inline std::vector<State> states() { return std::vector<State>(points, State(material())); }

inline std::vector<grainlaw_state*> handles(const std::vector<State>& states) {
  std::vector<grainlaw_state*> found;
  for (const State& state : states) found.push_back(state.get());
  return found;
}

struct Result {
  std::vector<double> P = std::vector<double>(4 * points);
  std::vector<double> A = std::vector<double>(16 * points);
  std::vector<grainlaw_status> status = std::vector<grainlaw_status>(points);
  std::vector<grainlaw_report> report =
      std::vector<grainlaw_report>(points, grainlaw_report_default());
};

inline Result evaluate(const std::vector<State>& states, int threads) {
  const auto F = deformations();
  const auto all = handles(states);
  Result found;
  EXPECT_EQ(grainlaw_evaluate_batch(points, all.data(), F.data(), GRAINLAW_WANT_TANGENT_EXACT,
                                    found.P.data(), found.A.data(), found.status.data(),
                                    found.report.data(), threads),
            GRAINLAW_OK);
  return found;
}

inline bool same_bits(const Result& a, const Result& b) {
  return same_bits(a.P, b.P) && same_bits(a.A, b.A);
}

}  // namespace grainlaw::test

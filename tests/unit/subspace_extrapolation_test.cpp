// Leaps along the slow modes of a relaxation, where the answer is known: springs to the ground.
#include "equilibrium/subspace_extrapolation.hpp"
#include "plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainlaw::core::test {
namespace {

constexpr std::size_t nodes = 40;
constexpr double anywhere = std::numeric_limits<double>::infinity();

// Springs of these stiffnesses in x, y and roll of all nodes [N/m].
struct Springs {
  double x, y, roll;
};

// Places under overdamped flow from a place of large moves, every mode by its own stiffness.
class Creep {
 public:
  explicit Creep(const Springs& springs) : springs_(springs), places_(nodes), forces_(nodes) {
    for (std::size_t q = 0; q < nodes; ++q) {
      const double phase = static_cast<double>(q);
      places_[q] = {std::sin(phase), std::cos(2 * phase), std::sin(3 * phase), 0.5};
    }
    slow.reserve(nodes);
    see();
  }

  void go_on(double time) {
    for (ParticleRecord& place : places_) {
      place.x *= std::exp(-time * springs_.x);
      place.y *= std::exp(-time * springs_.y);
      place.roll *= std::exp(-time * springs_.roll);
    }
    see();
  }

  [[nodiscard]] std::vector<ParticleRecord> place() const { return places_; }
  SubspaceExtrapolation slow;

 private:
  void see() {
    double residual = 0;
    for (std::size_t q = 0; q < nodes; ++q) {
      const ParticleRecord& place = places_[q];
      forces_[q] = {-springs_.x * place.x, -springs_.y * place.y, -springs_.roll * place.roll, 0};
      residual = std::max({residual, std::abs(forces_[q].x), std::abs(forces_[q].y)});
    }
    slow.see(places_, forces_, residual);
  }

  Springs springs_;
  std::vector<ParticleRecord> places_;
  std::vector<ForceRecord> forces_;
};

double furthest(const std::vector<ParticleRecord>& places) {
  double most = 0;
  for (const ParticleRecord& place : places) {
    most = std::max({most, std::abs(place.x), std::abs(place.y), std::abs(place.roll)});
  }
  return most;
}

TEST(slow_modes, as_many_of_them_as_moves_are_left_behind_in_one_leap) {
  Creep creep({0.01, 0.05, 0.2});
  for (int k = 0; k < 3; ++k) creep.go_on(4);
  ASSERT_TRUE(creep.slow.slow());
  auto records = creep.place();
  ASSERT_TRUE(creep.slow.extrapolate(records, anywhere, 1e-6));
  EXPECT_GT(furthest(creep.place()), 0.5);
  EXPECT_LT(furthest(records), 1e-9);
  for (const ParticleRecord& record : records) EXPECT_EQ(record.radius, 0.5);
}

TEST(slow_modes, nothing_leaps_back_to_an_unstable_equilibrium) {
  Creep creep({-0.05, -0.05, -0.05});
  for (int k = 0; k < 3; ++k) creep.go_on(4);
  auto records = creep.place();
  EXPECT_FALSE(creep.slow.extrapolate(records, anywhere, 1e-6));
  EXPECT_EQ(furthest(records), furthest(creep.place()));
}

TEST(slow_modes, an_unstable_mode_that_hardly_moves_yet_stays_where_it_is) {
  Creep creep({0.05, 0.05, -1e-4});
  for (int k = 0; k < 3; ++k) creep.go_on(4);
  const auto before = creep.place();
  auto records = before;
  ASSERT_TRUE(creep.slow.extrapolate(records, anywhere, 1e-6));
  for (std::size_t q = 0; q < nodes; ++q) {
    EXPECT_LT(std::abs(records[q].x), 1e-2);
    EXPECT_LT(std::abs(records[q].roll - before[q].roll), 0.1);
  }
}

TEST(slow_modes, no_leap_goes_further_than_its_limit) {
  Creep creep({0.01, 0.05, 0.2});
  for (int k = 0; k < 3; ++k) creep.go_on(4);
  const auto before = creep.place();
  auto records = before;
  ASSERT_TRUE(creep.slow.extrapolate(records, 1e-3, 1e-6));
  double most = 0;
  for (std::size_t q = 0; q < nodes; ++q) {
    most =
        std::max({most, std::abs(records[q].x - before[q].x), std::abs(records[q].y - before[q].y),
                  std::abs(records[q].roll - before[q].roll)});
  }
  EXPECT_NEAR(most, 1e-3, 1e-12);
}

TEST(slow_modes, what_settles_fast_is_left_to_the_relaxation) {
  Creep creep({0.5, 0.5, 0.5});
  EXPECT_FALSE(creep.slow.slow());
  for (int k = 0; k < 3; ++k) creep.go_on(4);
  EXPECT_FALSE(creep.slow.slow());
}

TEST(slow_modes, places_forgotten_count_no_more) {
  Creep creep({0.01, 0.05, 0.2});
  for (int k = 0; k < 3; ++k) creep.go_on(4);
  creep.slow.forget();
  EXPECT_FALSE(creep.slow.slow());
  for (int k = 0; k < 4; ++k) creep.go_on(4);
  EXPECT_TRUE(creep.slow.slow());
}

}  // namespace
}  // namespace grainlaw::core::test

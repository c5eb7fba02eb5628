// Points led to the stress that they begin with: reached, kept, saved, shared, refused.
#include "points_support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace grainlaw::test {
namespace {

// 60 discs or spheres at 20 kPa.
std::string small(int dimension, const std::string& more) {
  return "dimension = " + std::to_string(dimension) + (dimension == 2 ? "\nthickness = 0.1" : "") +
         "\n[packing]\ngenerator = \"compaction\"\ncount = 60\nradii = [3e-3, 5e-3]\nseed = 4\n"
         "pressure = 20e3\n[contact]\nlaw = \"frictional\"\nyoung = 1e8\nratio = 0.8\n"
         "friction = 0.5\n" +
         more;
}

Material small_material(int dimension, const std::string& more = "") {
  return Material::parse(small(dimension, more), ".");
}

const Material& discs() {
  static const Material instance = small_material(2);
  return instance;
}

const std::string drag = "[solver]\nviscous_number = 1e-3\n";
const std::string time = drag + "viscous_rate = 1e-2\n";

struct Packing {
  int dimension;
  std::string more;
};
const std::vector<Packing> packings{
    {2, ""}, {2, drag}, {2, time}, {2, "[boundary]\ntype = \"frame-p\"\n"}, {3, ""}, {3, drag}};

// Compression by -p along the last axis and -share p across.
std::vector<double> stress_of(int dimension, double p, double share, double shear = 0) {
  const auto d = static_cast<std::size_t>(dimension);
  std::vector<double> sigma(d * d);
  for (std::size_t k = 0; k < d; ++k) sigma[(d + 1) * k] = k + 1 == d ? -p : -share * p;
  sigma[d - 1] = sigma[(d - 1) * d] = shear * p;
  return sigma;
}

std::vector<double> one(int dimension) { return stress_of(dimension, -1, 1); }

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0, norm = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    squares += (a[k] - b[k]) * (a[k] - b[k]);
    norm += b[k] * b[k];
  }
  return std::sqrt(squares / norm);
}

std::vector<double> consolidate(Points& set, const std::vector<double>& sigma,
                                const grainlaw_consolidation& how) {
  std::vector<std::size_t> which(set.size());
  for (std::size_t k = 0; k < which.size(); ++k) which[k] = k;
  std::vector<double> reached(sigma.size());
  const auto result = set.consolidate(which, sigma, how, reached, 1);
  EXPECT_EQ(result.status, GRAINLAW_OK) << result.message();
  return reached;
}

grainlaw_consolidation by(grainlaw_route route, double overconsolidation = 1) {
  grainlaw_consolidation how = grainlaw_consolidation_default();
  how.route = route;
  how.overconsolidation = overconsolidation;
  return how;
}

TEST(consolidate, stress_is_reached_and_ten_steps_of_nothing_keep_it) {
  for (const Packing& packing : packings) {
    SCOPED_TRACE(packing.more + std::to_string(packing.dimension));
    Points set(small_material(packing.dimension, packing.more), 1);
    const std::vector<double> wanted = stress_of(packing.dimension, 60e3, 0.6, 0.1);
    const auto reached = consolidate(set, wanted, by(GRAINLAW_PROPORTIONAL));
    EXPECT_LT(distance(reached, wanted), 1e-8);
    EXPECT_LT(distance(set.measure(GRAINLAW_DEFORMATION_GRADIENT), one(packing.dimension)), 1e-15);
    EXPECT_NEAR(set.measure(GRAINLAW_REFERENCE_VOLUME)[0] / set.measure(GRAINLAW_VOLUME)[0], 1,
                1e-14);
    std::vector<double> P(wanted.size());
    set.set_time_step(0.1);
    for (int step = 0; step < 10; ++step) {
      ASSERT_TRUE(set.evaluate(one(packing.dimension), P));
      set.commit();
    }
    EXPECT_LT(distance(P, wanted), 1e-8);
    EXPECT_LT(distance(set.measure(GRAINLAW_CAUCHY_STRESS), wanted), 1e-8);
  }
}

TEST(consolidate, k0_leads_the_vertical_stress_and_finds_the_horizontal_one) {
  Points set(discs(), 10);
  std::vector<double> weight;
  for (std::size_t k = 0; k < 10; ++k) {
    const auto sigma = stress_of(2, 20e3 * (1.5 + static_cast<double>(k)), 1);
    weight.insert(weight.end(), sigma.begin(), sigma.end());
  }
  const auto reached = consolidate(set, weight, by(GRAINLAW_K0));
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_NEAR(reached[4 * k + 3] / weight[4 * k + 3], 1, 1e-8);
    EXPECT_NEAR(reached[4 * k + 1] / weight[4 * k + 3], 0, 1e-8);
    const double ratio = reached[4 * k] / reached[4 * k + 3];
    EXPECT_GT(ratio, 0.2);
    EXPECT_LT(ratio, 1);
  }
}

TEST(consolidate, overconsolidation_raises_k0) {
  for (const int dimension : {2, 3}) {
    double before = 0;
    for (const double ratio : {1.0, 2.0, 4.0}) {
      Points set(small_material(dimension), 1);
      auto how = by(GRAINLAW_K0, ratio);
      how.first_pressure = 25e3;
      const auto found = consolidate(set, stress_of(dimension, 100e3, 1), how);
      EXPECT_NEAR(found.back() / -100e3, 1, 1e-8);
      EXPECT_GT(found[0] / found.back(), before + 0.1) << dimension;
      before = found[0] / found.back();
    }
  }
}

TEST(consolidate, any_axis_is_the_one_of_k0) {
  for (const int dimension : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimension);
    for (const std::vector<double>& axis :
         {std::vector<double>{-7, 0, 0}, {1, 2, 0}, {1, -2, dimension == 3 ? 2.0 : 0.0}}) {
      Points set(small_material(dimension), 1);
      auto how = by(GRAINLAW_K0);
      std::copy(axis.begin(), axis.end(), how.axis);
      const auto found = consolidate(set, stress_of(dimension, 50e3, 1), how);
      const double length = std::hypot(axis[0], axis[1], axis[2]);
      double pressure = 0;
      for (std::size_t i = 0; i < d; ++i) {
        double traction = 0;
        for (std::size_t j = 0; j < d; ++j) traction += found[d * i + j] * axis[j] / length;
        EXPECT_NEAR(traction, -50e3 * axis[i] / length, 1e-3);
        pressure -= found[(d + 1) * i] / static_cast<double>(d);
      }
      EXPECT_LT(pressure, 45e3);  // less across the axis than along it
    }
  }
}

TEST(consolidate, goes_on_from_an_earlier_one) {
  Points set(discs(), 1), at_once(discs(), 1);
  consolidate(set, stress_of(2, 40e3, 0.7), by(GRAINLAW_PROPORTIONAL));
  const auto found = consolidate(set, stress_of(2, 80e3, 0.7), by(GRAINLAW_PROPORTIONAL));
  EXPECT_LT(distance(found, stress_of(2, 80e3, 0.7)), 1e-8);
  EXPECT_LT(distance(set.measure(GRAINLAW_DEFORMATION_GRADIENT), one(2)), 1e-15);
  const auto direct = stress_of(2, 80e3, 0.7);
  consolidate(at_once, direct, by(GRAINLAW_PROPORTIONAL));
  EXPECT_NEAR(set.measure(GRAINLAW_VOID_RATIO)[0], at_once.measure(GRAINLAW_VOID_RATIO)[0], 1e-3);
}

// P and A there, against central differences.
void expect_exact_tangent(Points& set, const std::vector<double>& F) {
  const std::size_t square = F.size();
  std::vector<double> P(square), A(square * square), plus(square), minus(square),
      difference(square), column(square);
  ASSERT_TRUE(set.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A));
  const double step = 1e-8;
  for (std::size_t k = 0; k < square; ++k) {
    auto moved = F;
    moved[k] += step;
    ASSERT_TRUE(set.evaluate(moved, plus));
    moved[k] -= 2 * step;
    ASSERT_TRUE(set.evaluate(moved, minus));
    for (std::size_t m = 0; m < square; ++m) {
      difference[m] = (plus[m] - minus[m]) / (2 * step);
      column[m] = A[m * square + k];
    }
    EXPECT_LT(distance(column, difference), 1e-4) << k;
  }
}

TEST(consolidate, tangent_and_rotation_are_those_of_the_new_reference) {
  for (const int dimension : {2, 3}) {
    const auto d = static_cast<std::size_t>(dimension), square = d * d;
    Points set(small_material(dimension), 1);
    consolidate(set, stress_of(dimension, 60e3, 0.7, 0.1), by(GRAINLAW_ISOTROPIC));
    std::vector<double> F = one(dimension), P(square), Q(square);
    // Loading from I: not every step of both signs slides alike where stresses were led there.
    F[square - 1] -= 1e-5;
    expect_exact_tangent(set, F);
    F[0] += 2e-5;
    F[square - 1] -= 5e-5;
    F[1] += 3e-5;
    expect_exact_tangent(set, F);
    ASSERT_TRUE(set.evaluate(F, P));
    set.commit();
    F[square - 1] -= 5e-5;
    expect_exact_tangent(set, F);
    // A quarter turn about the last axis, or in the plane.
    auto turned = F;
    for (std::size_t j = 0; j < d; ++j) {
      turned[j] = -F[d + j];
      turned[d + j] = F[j];
    }
    ASSERT_TRUE(set.evaluate(F, P));
    ASSERT_TRUE(set.evaluate(turned, Q));
    for (std::size_t j = 0; j < d; ++j) {
      EXPECT_NEAR(Q[j], -P[d + j], 1e-6 * 60e3);
      EXPECT_NEAR(Q[d + j], P[j], 1e-6 * 60e3);
    }
  }
}

TEST(consolidate, bytes_and_copies_go_on_with_the_same_bits) {
  for (const std::string& more : {std::string(), drag}) {
    const Material material = small_material(2, more);
    Points set(material, 2);
    auto sigma = stress_of(2, 40e3, 0.8);
    const auto deep = stress_of(2, 80e3, 0.8);
    sigma.insert(sigma.end(), deep.begin(), deep.end());
    consolidate(set, sigma, by(GRAINLAW_PROPORTIONAL));
    std::vector<double> P(8), Q(8), A(32), B(32);
    ASSERT_TRUE(set.evaluate(std::vector<double>{1, 0, 0, 1, 1, 0, 0, 1}, P,
                             GRAINLAW_WANT_TANGENT_EXACT, A));
    set.commit();
    Points copy(set), loaded(material, 2);
    loaded.load(set.save());
    State alone(material);
    const auto bytes = save_one(grainlaw_points_state(set.get(), 1));
    EXPECT_EQ(grainlaw_state_load(alone.get(), bytes.data(), bytes.size()), GRAINLAW_OK);
    const std::vector<double> F{1.0001, 2e-4, 0, 0.9995, 1.0001, 2e-4, 0, 0.9995};
    ASSERT_TRUE(set.evaluate(F, P));
    for (Points* other : {&copy, &loaded}) {
      ASSERT_TRUE(other->answer(Q, GRAINLAW_WANT_TANGENT_EXACT, B));
      EXPECT_TRUE(same_bits(A, B));
      ASSERT_TRUE(other->evaluate(F, Q));
      EXPECT_TRUE(same_bits(P, Q));
    }
    EXPECT_TRUE(
        same_bits(stress(alone, {1.0001, 2e-4, 0, 0.9995}), Tensor{P[4], P[5], P[6], P[7]}));
    // Bytes from before the consolidation bring the reference of the packing back.
    loaded.load(Points(material, 2).save());
    EXPECT_TRUE(same_bits(loaded.measure(GRAINLAW_REFERENCE_VOLUME),
                          Points(material, 2).measure(GRAINLAW_REFERENCE_VOLUME)));
  }
}

TEST(consolidate, points_that_are_copied_made_or_reverted_have_their_own_reference) {
  Points set(discs(), 2);
  consolidate(set, std::vector<double>{-4e4, 0, 0, -4e4, -6e4, 0, 0, -6e4},
              by(GRAINLAW_PROPORTIONAL));
  const auto saved = [](Points& of, std::size_t k) {
    return save_one(grainlaw_points_state(of.get(), k));
  };
  Points other(discs(), 3);
  const auto fresh = saved(other, 0);
  other.clone_some(std::vector<std::size_t>{2}, set, std::vector<std::size_t>{1});
  EXPECT_EQ(saved(other, 2), saved(set, 1));
  EXPECT_EQ(saved(other, 0), fresh);
  set.resize(3);
  EXPECT_EQ(saved(set, 1), saved(other, 2));
  EXPECT_EQ(saved(set, 2), fresh);
  const auto before = set.save();
  std::vector<double> P(12);
  ASSERT_TRUE(set.evaluate(std::vector<double>{1, 0, 0, .9999, 1, 0, 0, .9999, 1, 0, 0, .9999}, P));
  set.revert();
  EXPECT_EQ(set.save(), before);
}

TEST(consolidate, equal_points_get_the_bits_of_one_alone_with_any_number_of_threads) {
  Points set(discs(), 4), threads(discs(), 4), alone(discs(), 1);
  const auto sigma = stress_of(2, 50e3, 0.7), other = stress_of(2, 70e3, 0.8);
  std::vector<double> all;
  for (const auto& each : {sigma, other, sigma, sigma})
    all.insert(all.end(), each.begin(), each.end());
  consolidate(set, all, by(GRAINLAW_PROPORTIONAL));
  consolidate(alone, sigma, by(GRAINLAW_PROPORTIONAL));
  const std::vector<std::size_t> which{0, 1, 2, 3};
  EXPECT_EQ(threads.consolidate(which, all, grainlaw_consolidation_default(), {}, 3).status,
            GRAINLAW_OK);
  EXPECT_EQ(threads.save(), set.save());
  const auto bytes = save_one(grainlaw_points_state(alone.get(), 0));
  for (const std::size_t k : {0U, 2U, 3U})
    EXPECT_EQ(save_one(grainlaw_points_state(set.get(), k)), bytes);
}

// What is told of a call, whose points have to stay as they were.
std::string told(Points& set, std::vector<std::size_t> which, const std::vector<double>& sigma,
                 const grainlaw_consolidation& how, grainlaw_status expected, long point) {
  const auto before = set.save();
  grainlaw_summary summary = grainlaw_summary_default();
  const auto found = grainlaw_points_consolidate(set.get(), which.size(), which.data(),
                                                 sigma.data(), &how, nullptr, nullptr, 1, &summary);
  expect_refused(found, expected, summary.message);
  EXPECT_EQ(summary.first_failed, point);
  EXPECT_EQ(set.save(), before);
  return summary.message;
}

TEST(consolidate, wrong_stresses_are_told_with_the_point_and_change_nothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Points set(discs(), 4);
  const auto how = grainlaw_consolidation_default();
  const auto expect = [&](std::vector<double> sigma, const std::string& text) {
    const auto good = stress_of(2, 30e3, 1);
    sigma.insert(sigma.begin(), good.begin(), good.end());
    const std::string message = told(set, {1, 3}, sigma, how, GRAINLAW_BAD_ARGUMENT, 3);
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  expect({-1e5, 0, 0, nan}, "sigma22 is nan");
  expect({-1e5, 1e4, 0, -1e5}, "sigma12 is 10000 and sigma21 is 0");
  expect({-1e5, 0, 0, 1e3}, "the largest principal stress is 1000 Pa");
  expect({-1e5, 2e5, 2e5, -1e5}, "carry no tension");
  expect({0, 0, 0, 0}, "expected compression");
}

TEST(consolidate, wrong_numbers_and_options_are_told) {
  Points set(discs(), 2);
  const auto sigma = stress_of(2, 30e3, 1);
  const auto expect = [&](grainlaw_consolidation how, std::size_t point, const std::string& text) {
    const std::string message = told(set, {point}, sigma, how, GRAINLAW_BAD_ARGUMENT, -1);
    EXPECT_NE(message.find(text), std::string::npos) << message;
  };
  auto how = grainlaw_consolidation_default();
  expect(how, 2, "point 2, expected numbers below 2");
  how.overconsolidation = 0.5;
  expect(how, 0, "overconsolidation is 0.5");
  how = grainlaw_consolidation_default();
  how.first_pressure = -1;
  expect(how, 0, "first_pressure is -1");
  how = grainlaw_consolidation_default();
  how.largest_step = 0;
  expect(how, 0, "largest_step is 0");
  how = grainlaw_consolidation_default();
  how.size = 4;
  told(set, {0}, sigma, how, GRAINLAW_BAD_REPORT, -1);
}

TEST(consolidate, more_than_the_packing_carries_is_told_with_what_it_does) {
  for (const int dimension : {2, 3}) {
    const std::size_t square = dimension == 2 ? 4 : 9;
    const Material material = small_material(dimension);
    Points set(material, 2);
    auto sigma = stress_of(dimension, 30e3, 1);
    const auto steep = stress_of(dimension, 60e3, 0.02);
    sigma.insert(sigma.end(), steep.begin(), steep.end());
    const auto before = set.save();
    const auto start = measure_one(grainlaw_points_state(set.get(), 1), GRAINLAW_CAUCHY_STRESS);
    std::vector<double> reached(2 * square);
    std::vector<grainlaw_status> status(2);
    const std::vector<std::size_t> both{0, 1};
    const auto result =
        set.consolidate(both, sigma, grainlaw_consolidation_default(), reached, 1, status);
    EXPECT_EQ(result.status, GRAINLAW_NOT_CONVERGED);
    EXPECT_EQ(status[0], GRAINLAW_OK);
    EXPECT_EQ(status[1], GRAINLAW_NOT_CONVERGED);
    EXPECT_EQ(result.summary.first_failed, 1);
    EXPECT_NE(result.message().find("carries no more than sigma (11 "), std::string::npos)
        << result.message();
    EXPECT_EQ(set.save(), before);
    // The last stress lies on the way, and 0.95 of the way there is carried.
    std::vector<double> less(square);
    const double way = (reached.back() - start.back()) / (steep.back() - start.back());
    EXPECT_GT(way, 0.2);
    EXPECT_LT(way, 0.6);
    for (std::size_t k = 0; k < square; ++k) {
      EXPECT_NEAR(reached[square + k], start[k] + way * (steep[k] - start[k]), 10) << k;
      less[k] = start[k] + 0.95 * (reached[square + k] - start[k]);
    }
    for (std::size_t i = 0, d = dimension == 2 ? 2 : 3; i < d; ++i)
      for (std::size_t j = 0; j < i; ++j) less[d * i + j] = less[d * j + i];
    EXPECT_EQ(set.consolidate(std::vector<std::size_t>{1}, less).status, GRAINLAW_OK);
  }
}

}  // namespace
}  // namespace grainlaw::test

// What holds Newton's method back: line search, and a share of the elastic stiffness.
#include "fe/solver/elastic_share.hpp"
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace verification {
namespace {

// One element, compressed by 1.6 % in one load step: too much for Newton's method in one go.
std::vector<LoadStep> compress(const NewtonOptions& options, double strain = 0.016,
                               const Material& material = packing_material()) {
  Model model;
  model.mesh = box_mesh({0.05, 0.1}, {1, 1}, ElementKind::q4r);
  const auto& sets = model.mesh.node_sets;
  model.displacements.push_back({sets.at("left"), 0, Program{{{0, 0}}, {}}, "left_x"});
  model.displacements.push_back({sets.at("bottom"), 1, Program{{{0, 0}}, {}}, "bottom_y"});
  model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -0.1 * strain), "top_y"});
  model.loads.pressures.push_back({model.mesh.side_sets["right"], Program{{{0, 1e5}}, {}}, true});
  const auto solver = make_newton_solver(model, material, options, 1);
  std::vector<LoadStep> steps;
  for (int step = 0; step <= 1; ++step) steps.push_back(solver->advance(step, step));
  return steps;
}

// Corrections after the first of their attempt, and those of them that left a larger residual.
struct Count {
  int corrections = 0;
  int increases = 0;
};

Count count(const std::vector<LoadStep>& steps) {
  Count sum;
  for (const LoadStep& step : steps) {
    std::vector<std::size_t> ends(step.attempts.begin() + 1, step.attempts.end());
    ends.push_back(step.residuals.size());
    for (std::size_t a = 0; a < ends.size(); ++a)
      for (std::size_t k = step.attempts[a] + 2; k < ends[a]; ++k) {
        ++sum.corrections;
        if (step.residuals[k] > step.residuals[k - 1]) ++sum.increases;
      }
  }
  return sum;
}

TEST(line_search, never_increases_the_residual) {
  NewtonOptions options{.tolerance = 1e-6, .max_iterations = 15};
  EXPECT_GT(count(compress(options)).increases, 0);
  options.line_search = 4;
  const std::vector<LoadStep> steps = compress(options);
  EXPECT_GT(count(steps).corrections, 4);
  EXPECT_EQ(count(steps).increases, 0);
  EXPECT_LE(steps.back().residuals.back(), 1e-6);
}

TEST(line_search, of_bounded_corrections_applies_the_whole_displacement) {
  NewtonOptions options{
      .max_iterations = 100, .max_cuts = 0, .patience = 100, .loose_tolerance = 1};
  options.largest_correction = 8e-3;
  options.line_search = 4;
  const std::vector<LoadStep> steps = compress(options, 0.03, thirty_discs(2, 0));
  EXPECT_NEAR(steps.back().displacements.back(), -0.1 * 0.03, 1e-15);
}

// Increase, increase, slow, fast, fast.
TEST(elastic_share, rises_with_the_residual_and_goes_as_it_falls) {
  ElasticShare share(0.1);
  share.update(1, 0.5);
  EXPECT_EQ(share.value(), 0);
  share.update(1, 2);
  EXPECT_EQ(share.value(), 0.1);
  share.update(1, 2);
  EXPECT_DOUBLE_EQ(share.value(), 0.4);
  share.update(1, 0.5);
  EXPECT_DOUBLE_EQ(share.value(), 0.4);
  share.update(1, 0.8);
  EXPECT_DOUBLE_EQ(share.value(), 0.4 / 3);
  share.update(1, 0.1);
  EXPECT_EQ(share.value(), 0.1);
  share.update(1, 0.1);
  EXPECT_EQ(share.value(), 0);
  for (int k = 0; k < 9; ++k) share.update(1, 1);
  EXPECT_EQ(share.value(), 1);
}

TEST(elastic_share, is_none_where_the_residual_falls) {
  NewtonOptions options{.tolerance = 1e-6};
  const std::vector<double> plain = compress(options, 1e-3).back().residuals;
  options.elastic_share = 0.1;
  EXPECT_EQ(compress(options, 1e-3).back().residuals, plain);
}

TEST(elastic_share, leads_to_an_equilibrium_where_the_residual_rises) {
  NewtonOptions plain{.tolerance = 1e-6, .max_iterations = 40}, held = plain;
  held.elastic_share = 0.1;
  int increases = 0, changed = 0;
  for (const double strain : {0.014, 0.016, 0.018, 0.02}) {
    const auto without = compress(plain, strain), with = compress(held, strain);
    increases += count(without).increases;
    changed += with.back().residuals != without.back().residuals ? 1 : 0;
    EXPECT_LE(with.back().residuals.back(), 1e-6) << strain;
  }
  EXPECT_GT(increases, 0);
  EXPECT_GT(changed, 0);
}

}  // namespace
}  // namespace verification

// The line search of Newton's method.
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace verification {
namespace {

// One element, compressed by 1.6 % in one load step: too much for Newton's method in one go.
std::vector<LoadStep> compress(const NewtonOptions& options) {
  Model model;
  model.mesh = rectangle_mesh({0.05, 0.1}, {1, 1}, ElementKind::q4r);
  const auto& sets = model.mesh.node_sets;
  model.displacements.push_back({sets.at("left"), 0, Program{{{0, 0}}, {}}, "left_x"});
  model.displacements.push_back({sets.at("bottom"), 1, Program{{{0, 0}}, {}}, "bottom_y"});
  model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -1.6e-3), "top_y"});
  model.loads.pressures.push_back({model.mesh.side_sets["right"], Program{{{0, 1e5}}, {}}, true});
  const Material material = packing_material();
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

}  // namespace
}  // namespace verification

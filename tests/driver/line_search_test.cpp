// The line search of Newton's method.
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace verification {
namespace {

// Load steps far too large for the elastic tangent: one element compressed by 1 % each.
std::vector<LoadStep> compress(const NewtonOptions& options) {
  Model model;
  model.mesh = rectangle_mesh({0.05, 0.1}, {1, 1}, ElementKind::q4);
  const auto& sets = model.mesh.node_sets;
  model.displacements.push_back({sets.at("left"), 0, Program{{{0, 0}}, {}}, "left_x"});
  model.displacements.push_back({sets.at("bottom"), 1, Program{{{0, 0}}, {}}, "bottom_y"});
  model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -2e-3), "top_y"});
  model.loads.pressures.push_back({model.mesh.side_sets["right"], Program{{{0, 1e5}}, {}}, true});
  const Material material = packing_material();
  const auto solver = make_newton_solver(model, material, options, 1);
  std::vector<LoadStep> steps;
  for (int step = 0; step <= 2; ++step) steps.push_back(solver->advance(0.5 * step, step));
  return steps;
}

// Times a residual is larger than the one before within an attempt; entry 0 is the load alone.
int increases(const std::vector<LoadStep>& steps) {
  int count = 0;
  for (const LoadStep& step : steps)
    for (std::size_t k = 2; k < step.residuals.size(); ++k)
      if (step.residuals[k] > step.residuals[k - 1]) ++count;
  return count;
}

TEST(line_search, never_increases_the_residual) {
  const NewtonOptions plain{.tolerance = 1e-6, .max_iterations = 60};
  NewtonOptions searching = plain;
  searching.line_search = 6;
  const auto without = compress(plain);
  const auto with = compress(searching);
  EXPECT_GT(increases(without), 0);
  for (const LoadStep& step : with) EXPECT_EQ(step.record.effort.cuts, 0);
  EXPECT_EQ(increases(with), 0);
  EXPECT_NEAR(with.back().reactions[2], without.back().reactions[2],
              1e-4 * std::abs(without.back().reactions[2]));
}

}  // namespace
}  // namespace verification

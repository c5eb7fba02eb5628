// What the biaxial tests that localise rest on: meshes that agree before the peak, and corrections of
// Newton's method that are bounded.
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

namespace verification {
namespace {

// Smooth platens and membranes under 100 kPa, compressed to this axial strain.
Model specimen(int divisions, double strain) {
  Model model;
  model.mesh = rectangle_mesh({0.05, 0.1}, {divisions, divisions}, ElementKind::q4);
  auto& sets = model.mesh.node_sets;
  model.displacements = {{sets["bottom"], 1, Program::linear(0, 0), "bottom_y"},
                         {sets["top"], 1, Program::linear(0, -0.1 * strain), "top_y"},
                         {sets["bottom_left"], 0, Program::linear(0, 0), "bottom_left_x"}};
  for (const char* side : {"left", "right"})
    model.loads.pressures.push_back(
        {model.mesh.side_sets[side], Program::linear(100e3, 100e3), true});
  return model;
}

struct Result {
  Record record;
  int cuts = 0;
};

Result compress(int divisions, const NewtonOptions& options) {
  constexpr double strain = 2e-3;
  constexpr int steps = 2;
  const Model model = specimen(divisions, strain);
  const Material material = packing_material();
  const auto solver = make_newton_solver(model, material, options, 1);
  Result result;
  run_load_steps(*solver, 1, steps, steps, [&](const LoadStep& step, const Solver&) {
    result.record = step.record;
    result.cuts += step.record.effort.cuts;
  });
  return result;
}

TEST(localising, meshes_agree_before_the_peak) {
  const NewtonOptions options{.tolerance = 1e-6};
  const Result coarse = compress(1, options);
  const Result fine = compress(2, options);
  EXPECT_EQ(coarse.cuts + fine.cuts, 0);  // the same increments
  EXPECT_LT((fine.record.cauchy - coarse.record.cauchy).norm(), 1e-5 * coarse.record.cauchy.norm());
  EXPECT_NEAR(coarse.record.cauchy(0, 0), -100e3, 1e-4 * 100e3);
}

TEST(localising, a_load_increment_beyond_the_largest_correction_is_cut) {
  NewtonOptions options{.tolerance = 1e-6};
  const Result whole = compress(1, options);
  EXPECT_EQ(whole.cuts, 0);
  options.largest_correction = 7e-4;  // less than the 0.1 % of a step
  const Result cut = compress(1, options);
  EXPECT_GE(cut.cuts, 2);
  // Smaller increments: the same up to the error of the increment.
  EXPECT_LT((cut.record.cauchy - whole.record.cauchy).norm(), 2e-3 * whole.record.cauchy.norm());
}

}  // namespace
}  // namespace verification

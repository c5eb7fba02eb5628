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
  model.mesh = box_mesh({0.05, 0.1}, {divisions, divisions}, ElementKind::q4);
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
  BodyRecord record;
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  // where the upper right one went [m]
  int cuts = 0;
  int iterations = 0;
};

Result compress(int divisions, const NewtonOptions& options,
                const Material& material = packing_material(), double strain = 2e-3) {
  constexpr int steps = 2;
  const Model model = specimen(divisions, strain);
  const auto solver = make_newton_solver(model, material, options, 1);
  Result result;
  run_load_steps(*solver, 1, steps, steps, [&](const LoadStep& step, const Solver&) {
    result.record = step.record;
    result.cuts += step.record.effort.cuts;
    result.iterations += step.record.effort.iterations;
  });
  result.corner =
      solver->displacement().segment<2>(2 * model.mesh.node_sets.at("top_right").front());
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

// Uniform deformation is in equilibrium there.
TEST(localising, meshes_of_a_symmetric_packing_agree_in_their_displacements) {
  const NewtonOptions options{.tolerance = 1e-9};
  const Result coarse = compress(1, options, lattice_material());
  const Result fine = compress(2, options, lattice_material());
  EXPECT_NEAR(coarse.record.deformation(0, 1), 0, 1e-9);
  EXPECT_LT((fine.corner - coarse.corner).norm(), 1e-7 * coarse.corner.norm());
}

// A packing that is not symmetric shears by itself between smooth platens. By the balance of moments
// a uniform deformation then asks for P21 = P12 F22 / F11 - P22 F12 / F11 on the sides. The membranes
// give p F12. What is missing, the deviatoric stress times F12, bends the sides of a mesh that has
// nodes there.
TEST(localising, meshes_of_a_packing_that_shears_differ_by_what_membranes_do_not_balance) {
  const NewtonOptions options{.tolerance = 1e-8};
  const Result coarse = compress(1, options), fine = compress(2, options);
  const Tensor &F = coarse.record.deformation, P = coarse.record.stress;
  EXPECT_NEAR(P(0, 1), 0, 1e-6 * 100e3);
  EXPECT_GT(std::abs(F(0, 1)), 1e-4);
  const double missing = P(1, 0) - 100e3 * F(0, 1);
  EXPECT_NEAR(missing, (-P(1, 1) / F(0, 0) - 100e3) * F(0, 1), 1e-3 * std::abs(missing));
  const double apart = (fine.corner - coarse.corner).norm() / coarse.corner.norm();
  EXPECT_GT(apart, 1e-4);
  EXPECT_LT(apart, 1e-2);
}

TEST(localising, a_correction_beyond_the_largest_is_made_in_parts_to_the_same_equilibrium) {
  NewtonOptions options{.tolerance = 1e-6};
  const Result whole = compress(1, options);
  options.largest_correction = 2e-4;  // a fifth of the 0.1 % of a step
  const Result bounded = compress(1, options);
  EXPECT_EQ(whole.cuts + bounded.cuts, 0);
  EXPECT_GE(bounded.iterations, whole.iterations + 4);
  EXPECT_LT((bounded.record.cauchy - whole.record.cauchy).norm(),
            1e-5 * whole.record.cauchy.norm());
}

// Between rough platens, under membranes, past the peak: there an unbounded correction asks for a
// stretch that no point takes, however small the part of the step is.
TEST(localising, bands_are_followed_by_corrections_that_points_take) {
  Model model;
  model.mesh = box_mesh({0.06, 0.12}, {2, 4}, ElementKind::q4r);
  auto& sets = model.mesh.node_sets;
  for (const int component : {0, 1})
    model.displacements.push_back({sets["bottom"], component, Program::linear(0, 0), "bottom"});
  model.displacements.push_back({sets["top"], 0, Program::linear(0, 0), "top_x"});
  model.displacements.push_back({sets["top"], 1, Program::linear(0, -7.2e-3), "top_y"});
  for (const char* side : {"left", "right"})
    model.loads.pressures.push_back(
        {model.mesh.side_sets[side], Program::linear(100e3, 100e3), true});
  const auto solver =
      make_newton_solver(model, thirty_discs(1, 1e-3), NewtonOptions{.tolerance = 1e-6}, 1);
  solver->set_load_step(0.05);
  int steps = 0;
  const auto observe = [&](const LoadStep&, const Solver&) { ++steps; };
  EXPECT_NO_THROW(run_load_steps(*solver, 1, 20, 20, observe));
  EXPECT_EQ(steps, 21);
}

}  // namespace
}  // namespace verification

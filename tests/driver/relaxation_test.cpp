// Dynamic relaxation against Newton's method.
#include "fe/solver/relaxation.hpp"
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace verification {
namespace {

// Drained biaxial compression between smooth platens.
Model biaxial(int columns, int rows, double strain) {
  Model model;
  model.mesh = box_mesh({0.05, 0.1}, {columns, rows}, ElementKind::q4);
  const auto& sets = model.mesh.node_sets;
  model.displacements.push_back({sets.at("left"), 0, Program{{{0, 0}}, {}}, "left_x"});
  model.displacements.push_back({sets.at("bottom"), 1, Program{{{0, 0}}, {}}, "bottom_y"});
  model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -0.1 * strain), "top_y"});
  model.loads.pressures.push_back({model.mesh.side_sets["right"], Program{{{0, 1e5}}, {}}, true});
  return model;
}

TEST(relaxation, ends_at_the_equilibrium_of_newton) {
  const Model model = biaxial(1, 1, 2e-3);
  const Material material = packing_material();
  const auto newton = make_newton_solver(model, material, {.tolerance = 1e-8}, 1);
  const auto relaxation = make_relaxation_solver(model, material, {.tolerance = 1e-8}, 1);
  for (int step = 0; step <= 2; ++step) {
    const LoadStep expected = newton->advance(0.5 * step, step);
    const LoadStep found = relaxation->advance(0.5 * step, step);
    EXPECT_LE(found.residuals.back(), 1e-8);
    EXPECT_LT((relaxation->displacement() - newton->displacement()).norm(),
              1e-6 * 1e-4);  // of the displacement of a step [m]
    ASSERT_EQ(found.reactions.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(found.reactions[k], expected.reactions[k],
                  1e-6 * std::abs(expected.reactions[k]));
  }
}

TEST(relaxation, a_step_that_takes_too_many_iterations_is_cut_or_fails) {
  const Model model = biaxial(1, 1, 2e-3);
  const Material material = lattice_material();
  const auto cut = make_relaxation_solver(model, material, {.max_iterations = 12}, 1);
  int told = 0;
  cut->observe_cuts([&](double part, const std::string& reason) {
    ++told;
    EXPECT_LT(part, 1);
    EXPECT_NE(reason.find("did not converge"), std::string::npos) << reason;
  });
  cut->advance(0, 0);
  EXPECT_EQ(told, 0);
  const LoadStep step = cut->advance(1, 1);
  EXPECT_GT(step.record.effort.cuts, 0);
  EXPECT_EQ(told, step.record.effort.cuts);
  EXPECT_LE(step.residuals.back(), 1e-6);
  const auto failing =
      make_relaxation_solver(model, material, {.max_iterations = 2, .max_cuts = 1}, 1);
  try {
    failing->advance(0, 0);
    failing->advance(1, 1);
    ADD_FAILURE() << "two iterations were enough";
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("did not converge"), std::string::npos);
  }
}

TEST(relaxation, a_restored_run_goes_on_to_the_same_bits) {
  const Model model = biaxial(1, 2, 1e-3);
  const Material material = lattice_material();
  const auto make = [&] { return make_relaxation_solver(model, material, {}, 1); };
  const auto whole = make();
  whole->advance(0.5, 1);
  CheckpointWriter out;
  whole->save(out);
  const auto restored = make();
  CheckpointReader in(out.bytes(), "memory");
  restored->restore(in);
  const LoadStep expected = whole->advance(1, 2);
  const LoadStep found = restored->advance(1, 2);
  EXPECT_EQ(whole->displacement(), restored->displacement());
  EXPECT_EQ(expected.reactions, found.reactions);
}

}  // namespace
}  // namespace verification

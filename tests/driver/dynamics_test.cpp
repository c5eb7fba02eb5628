// Explicit dynamics against closed forms, on a string of bonded discs: a linear elastic bar.
#include "fe/solver/dynamics.hpp"
#include "../data.hpp"
#include "fe/mesh/mass.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace verification {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double density = 2000 * pi / 4;  // [kg/m3]
constexpr double modulus = 1e4 / 1e-3;     // kn / thickness [Pa]
const double wave_speed = std::sqrt(modulus / density);

Material string_material() {
  MaterialSource source;
  source.file = grainlaw::test::data_file("string.toml");
  source.base = grainlaw::test::data_folder();
  return make_material(source);
}

// A bar of square elements that moves along x alone, held at its left end.
Model bar(int elements, double size) {
  Model model;
  model.mesh = box_mesh({elements * size, size}, {elements, 1}, ElementKind::q4r);
  const Program held{{{0, 0}}, {}};
  model.displacements.push_back({model.mesh.node_sets["left"], 0, held, "left_x"});
  model.displacements.push_back({model.mesh.node_sets["bottom"], 1, held, "bottom_y"});
  model.displacements.push_back({model.mesh.node_sets["top"], 1, held, "top_y"});
  return model;
}

// One element under a traction that acts from the start on: u = f / k (1 - cos wt).
struct Oscillator {
  Model model = bar(1, 0.1);
  double stiffness = modulus;  // of the element, height over length 1 [N/m2]
  double frequency = std::sqrt(modulus / (density * 0.5 * 0.1 * 0.1));  // [1/s]
  double traction = -1e-4 * modulus;

  Oscillator() {
    model.loads.tractions.push_back(
        {model.mesh.side_sets["right"], 0, Program{{{0, traction}}, {}}});
  }
  [[nodiscard]] double deflection() const { return traction * 0.1 / stiffness; }
  [[nodiscard]] double right_end(const Solver& solver) const {
    return solver.displacement()(2 * model.mesh.node_sets.at("right").front());
  }
};

TEST(dynamics, masses_add_up_and_are_positive) {
  for (const auto kind : {ElementKind::q4, ElementKind::q4r, ElementKind::q8, ElementKind::t3}) {
    const Mesh mesh = box_mesh({2, 3}, {3, 2}, kind);
    const Eigen::VectorXd mass = lumped_mass(mesh, 10);
    EXPECT_GT(mass.minCoeff(), 0);
    EXPECT_NEAR(mass.sum(), 2 * 60, 1e-11);
  }
}

TEST(dynamics, one_element_vibrates_at_its_natural_frequency) {
  const Oscillator oscillator;
  const double period = 2 * pi / oscillator.frequency;
  const Material material = string_material();
  const auto solver = make_dynamics_solver(
      oscillator.model, material,
      {.duration = 10 * period, .density = density, .time_step = period / 200}, 1);
  for (const double turns : {0.25, 0.5, 1.0, 9.75, 10.0}) {
    solver->advance(turns * period, 1);
    const double exact = oscillator.deflection() * (1 - std::cos(2 * pi * turns));
    EXPECT_NEAR(oscillator.right_end(*solver), exact, 5e-3 * std::abs(oscillator.deflection()));
  }
}

TEST(dynamics, damping_lets_the_amplitude_decay) {
  const Oscillator oscillator;
  const double period = 2 * pi / oscillator.frequency;
  const double damping = 0.2 * oscillator.frequency;
  const Material material = string_material();
  const auto solver = make_dynamics_solver(
      oscillator.model, material,
      {.duration = 3 * period, .density = density, .damping = damping, .time_step = period / 400},
      1);
  const double damped = std::sqrt(1 - 0.01) * oscillator.frequency;
  LoadStep last;
  for (const double time : {0.5 * period, period, 3 * period}) {
    last = solver->advance(time, 1);
    const double swing = std::cos(damped * time) + 0.5 * damping / damped * std::sin(damped * time);
    const double exact = oscillator.deflection() * (1 - std::exp(-0.5 * damping * time) * swing);
    EXPECT_NEAR(oscillator.right_end(*solver), exact, 2e-3 * std::abs(oscillator.deflection()));
  }
  EXPECT_GT(last.energies->damped, 0.5 * last.energies->external);
  EXPECT_NEAR(last.energies->balance(), 0, 1e-3 * last.energies->external);
}

TEST(dynamics, a_reaction_holds_twice_the_load_at_the_turning_point) {
  const Oscillator oscillator;
  const double period = 2 * pi / oscillator.frequency;
  const Material material = string_material();
  const auto solver =
      make_dynamics_solver(oscillator.model, material,
                           {.duration = period, .density = density, .time_step = period / 200}, 1);
  const LoadStep step = solver->advance(0.5 * period, 1);
  EXPECT_NEAR(step.reactions[0], -2 * oscillator.traction * 0.1,
              1e-2 * std::abs(oscillator.traction) * 0.1);
}

TEST(dynamics, a_pulse_travels_at_the_wave_speed) {
  constexpr double size = 2.2e-3;
  Model model = bar(80, size);
  const double period = 60 * size / wave_speed;
  Program pulse{{{0, 0}}, {}};
  pulse.sine = {1e-5, period, 0, 0.5};
  model.displacements.push_back({model.mesh.node_sets["right"], 0, pulse, "right_x"});
  const Material material = string_material();
  const double duration = 70 * size / wave_speed;
  const auto solver =
      make_dynamics_solver(model, material, {.duration = duration, .density = density}, 1);
  // When the mean of the pulse, weighted by the displacement, passes these columns of nodes.
  std::array<double, 2> weight{}, moment{};
  double largest = 0, total = 0;
  constexpr std::array<int, 2> columns{70, 45};
  constexpr int steps = 70;
  for (int step = 1; step <= steps; ++step) {
    const double time = duration * step / steps;
    const LoadStep result = solver->advance(time, step);
    for (std::size_t k = 0; k < 2; ++k) {
      const double moved = solver->displacement()(2 * columns[k]);
      weight[k] += moved;
      moment[k] += moved * time;
    }
    largest = std::max(largest, std::abs(result.energies->balance()));
    total = std::max(total, result.energies->external);
  }
  EXPECT_LT(largest, 0.05 * total);  // the pulse starts with a jump of the velocity
  const double travelled = moment[1] / weight[1] - moment[0] / weight[0];
  EXPECT_NEAR(25 * size / travelled, wave_speed, 0.01 * wave_speed);
}

TEST(dynamics, energy_does_not_drift) {
  const Oscillator oscillator;
  const double period = 2 * pi / oscillator.frequency;
  const Material material = string_material();
  const auto solver = make_dynamics_solver(
      oscillator.model, material, {.duration = 100 * period, .density = density, .safety = 0.3}, 1);
  const double scale = std::abs(oscillator.traction * 0.1 * oscillator.deflection());
  for (int turn = 1; turn <= 100; ++turn)
    EXPECT_LT(std::abs(solver->advance(turn * period, turn).energies->balance()), 0.05 * scale);
}

TEST(dynamics, the_critical_time_step_is_the_limit_of_stability) {
  const Oscillator oscillator;
  const double critical = 2 / oscillator.frequency;
  const double duration = 400 * critical;
  const Material material = string_material();
  const auto run = [&](double ratio) {
    make_dynamics_solver(oscillator.model, material,
                         {.duration = duration, .density = density, .time_step = ratio * critical},
                         1)
        ->advance(duration, 1);
  };
  EXPECT_NO_THROW(run(0.98));
  try {
    run(1.02);
    ADD_FAILURE() << "an unstable time step was accepted";
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("unstable"), std::string::npos) << error.what();
  }
  const auto own = make_dynamics_solver(oscillator.model, material,
                                        {.duration = duration, .density = density, .safety = 1}, 1);
  EXPECT_NEAR(own->advance(duration, 1).record.effort.iterations, 400, 2);
}

TEST(dynamics, a_restored_run_goes_on_to_the_same_bits) {
  const Oscillator oscillator;
  const double period = 2 * pi / oscillator.frequency;
  const Material material = string_material();
  const auto make = [&] {
    return make_dynamics_solver(oscillator.model, material,
                                {.duration = period, .density = density, .damping = 1}, 1);
  };
  const auto whole = make();
  whole->advance(0.3 * period, 1);
  CheckpointWriter out;
  whole->save(out);
  const auto restored = make();
  CheckpointReader in(out.bytes(), "memory");
  restored->restore(in);
  const LoadStep expected = whole->advance(0.7 * period, 2);
  const LoadStep found = restored->advance(0.7 * period, 2);
  EXPECT_EQ(whole->displacement(), restored->displacement());
  EXPECT_EQ(expected.energies->balance(), found.energies->balance());
  EXPECT_EQ(expected.reactions, found.reactions);
}

TEST(dynamics, a_support_that_jumps_at_the_start_is_refused) {
  Model model = bar(1, 0.1);
  model.displacements.push_back(
      {model.mesh.node_sets["right"], 0, Program{{{0, 1e-3}}, {}}, "right_x"});
  EXPECT_THROW(make_dynamics_solver(model, string_material(), {.density = density}, 1), InputError);
}

}  // namespace
}  // namespace verification

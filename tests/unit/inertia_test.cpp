// Volumes with the inertia of their particles: closed forms, particles that are moved by themselves, exact
// tangents, and what a state keeps.
#include "boundary_support.hpp"
#include "law_support.hpp"
#include "moving_cell.hpp"
#include "state/serialise.hpp"
#include "tangent_support.hpp"

#include "base/error.hpp"
#include "increment/particle_masses.hpp"
#include "io/text_file.hpp"
#include "material/material_file.hpp"
#include "math/inner_product.hpp"
#include "packing/geometry.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr Tensor squeeze{0.35e-3, 1e-4, -1e-4, -1e-3};

MaterialDescription with_inertia(MaterialDescription description) {
  description.solver.inertia = true;
  return description;
}

// Frequency of a mean particle on one contact [1/s].
double frequency_of(const Material& material) {
  const double radius = mean_radius(material.packing.radius);
  return std::sqrt(material.law.stiffness(radius, radius) /
                   particle_mass<2>(material.packing.density, radius, material.packing.thickness));
}

// States that were squeezed so fast that their particles lag behind.
void shake(State& state, int steps, double step) {
  state.set_time_step(step / frequency_of(state.material()));
  for (int n = 0; n < steps; ++n) {
    const Evaluation at = evaluate(state, sum(state.committed().deformation, 1, squeeze));
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    state.commit();
  }
}

// Two discs in a row that touch each other on both sides, and themselves above and below: the one
// swings against the other on four springs, with the frequency 2 sqrt(kn / m).
class TwoDiscs {
 public:
  TwoDiscs() {
    Packing packing;
    packing.thickness = 0.5;
    packing.density = 3;
    packing.cell = {3.8, 0, 0, 1.9};
    packing.position = {0, 1.9, 0, 0};
    packing.radius = {1, 1};
    ContactLaw law;
    law.normal_stiffness = 1000;
    law.ratio = 1;
    law.friction = 1;
    material = make_material(with_inertia(describe(packing, law)));
    mass = 3 * 0.5 * std::numbers::pi;
    frequency = 2 * std::sqrt(1000 / mass);
  }
  [[nodiscard]] State swinging(double velocity) const {
    State state(material);
    Configuration start = state.committed();
    start.velocity.assign(start.coordinates.size(), 0.0);
    start.velocity[0] = -velocity;
    start.velocity[1] = velocity;
    state.restore(start);
    return state;
  }
  // Half of the change of the distance.
  static double apart(const State& state) {
    const auto& z = state.committed().coordinates;
    return 0.5 * (z[1] - z[0] - 1.9);
  }

  std::shared_ptr<const Material> material;
  double mass, frequency;
};

TEST(inertia, two_discs_swing_with_their_period) {
  const TwoDiscs discs;
  const double period = 2 * std::numbers::pi / discs.frequency;
  const double velocity = 1e-2 * discs.frequency;  // amplitude: a fifth of the overlaps
  const auto error = [&](int steps) {
    State state = discs.swinging(velocity);
    state.set_time_step(period / steps);
    double largest = 0;
    for (int n = 1; n <= 3 * steps; ++n) {
      advance(state, identity);
      const double exact = 1e-2 * std::sin(2 * std::numbers::pi * n / steps);
      largest = std::max(largest, std::abs(TwoDiscs::apart(state) - exact) / 1e-2);
    }
    return largest;
  };
  const double coarse = error(40), fine = error(80);
  // A phase of (w dt)^2 / 12 is lost a radian.
  const double lag = 6 * std::numbers::pi * std::pow(2 * std::numbers::pi / 40, 2) / 12;
  EXPECT_NEAR(coarse, lag, 0.05 * lag);
  EXPECT_NEAR(coarse / fine, 4, 0.1);
}

// The amplitude of a step is known: |1 + i (1 - theta) w dt| / |1 - i theta w dt|.
TEST(inertia, energy_is_kept_over_a_hundred_periods) {
  const TwoDiscs discs;
  for (const int steps : {40, 10}) {
    State state = discs.swinging(1e-2 * discs.frequency);
    const double step = 2 * std::numbers::pi / steps;  // times the frequency
    state.set_time_step(step / discs.frequency);
    const double at_rest = measure(State(discs.material), GRAINLAW_ELASTIC_ENERGY);
    const auto energy = [&] {
      return measure(state, GRAINLAW_ELASTIC_ENERGY) + measure(state, GRAINLAW_KINETIC_ENERGY) -
             at_rest;
    };
    const double start = energy();
    EXPECT_NEAR(start, discs.mass * std::pow(1e-2 * discs.frequency, 2), 1e-9 * start);
    for (int n = 0; n < 100 * steps; ++n) advance(state, identity);
    const double ratio = std::pow(0.25 * step, 4);  // of a contact's frequency, half of the mode's
    const double theta = 1 - 0.5 / (1 + ratio);
    const double squares = (1 + std::pow((1 - theta) * step, 2)) / (1 + std::pow(theta * step, 2));
    const double kept = std::pow(squares, 100 * steps);
    EXPECT_NEAR(energy() / start, kept, 1e-5) << steps;
    if (steps == 40) {
      EXPECT_GT(kept, 1 - 3e-4);
    }
  }
}

// The period of a wheel between two others shows its moment of inertia.
TEST(inertia, a_rolling_disc_has_half_of_its_mass) {
  const TwoDiscs discs;
  State state(discs.material);
  Configuration start = state.committed();
  start.velocity.assign(start.coordinates.size(), 0.0);
  start.velocity[4] = 1e-3;
  start.velocity[5] = -1e-3;
  state.restore(start);
  // Opposite spins slip at none of their two contacts. Each slips on itself, by its height, 1.9.
  const double frequency = std::sqrt(1000 * 1.9 * 1.9 / (0.5 * discs.mass));
  const double step = 2 * std::numbers::pi / frequency / 400;
  state.set_time_step(step);
  for (int n = 0; n < 100; ++n) advance(state, identity);
  EXPECT_NEAR(state.committed().velocity[4], 0, 1e-7);
  EXPECT_NEAR(state.committed().coordinates[4], 1e-3 / frequency, 1e-4 * 1e-3 / frequency);
}

TEST(inertia, rest_stays_at_rest) {
  const auto material = make_material(with_inertia(describe(small_packing(), rough_law())));
  State state(material);
  const Tensor before = state.committed().stress;
  state.set_time_step(0.3 / frequency_of(*material));
  for (int n = 0; n < 20; ++n) advance(state, identity);
  EXPECT_LT(relative_difference(state.committed().stress, before), 1e-7);
  EXPECT_LT(measure(state, GRAINLAW_KINETIC_ENERGY),
            1e-12 * measure(state, GRAINLAW_ELASTIC_ENERGY));
}

// Particles that no contact holds fly, and press on the cell as a gas does; a stretch G takes their
// momentum along by G^-T.
TEST(inertia, loose_particles_are_a_gas) {
  const auto material = make_material(with_inertia(describe(small_packing(), smooth_law())));
  State state(material);
  Configuration start = state.committed();
  const std::size_t n = material->packing.size();
  const auto scale = [&](double factor) {  // all in place, far apart
    for (std::size_t k = 0; k < 2 * n; ++k) start.coordinates[k] *= factor;
    for (double& f : start.deformation) f *= factor;
  };
  scale(1.2);
  start.contacts.clear();
  start.velocity.assign(start.coordinates.size(), 0.0);
  for (std::size_t p = 0; p < n; ++p) start.velocity[p] = p % 2 == 0 ? 3 : -3;
  state.restore(start);
  state.set_time_step(1e-9);
  const double energy = measure(state, GRAINLAW_KINETIC_ENERGY);
  const Tensor F{1.18, 0, 0, 1.2};
  const Evaluation at = evaluate(state, F, TangentKind::exact);
  ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
  const double volume = material->space.reference_volume;
  const double faster = 0.5 * (1 + 1.2 / 1.18);  // mean of both ends, twice
  EXPECT_NEAR(measure(state, GRAINLAW_KINETIC_ENERGY), energy * std::pow(2 * faster - 1, 2),
              1e-9 * energy);
  EXPECT_NEAR(at.stress[0], -2 * measure(state, GRAINLAW_KINETIC_ENERGY) / 1.18 / volume,
              1e-9 * std::abs(at.stress[0]));
  EXPECT_NEAR(at.stress[3], 0, 1e-9 * std::abs(at.stress[0]));
  expect_derivative(state, F);
}

TEST(inertia, tangent_matches_central_differences) {
  for (const double step : {0.05, 0.5, 4.0}) {
    for (const auto type :
         {BoundaryType::periodic_cell, BoundaryType::frame_p, BoundaryType::frame_d}) {
      SCOPED_TRACE(std::to_string(step) + ", boundary " + std::to_string(static_cast<int>(type)));
      State state(make_material(with_inertia(describe(small_packing(), rough_law(), type))));
      shake(state, 3, step);
      expect_derivative(state, sum(state.committed().deformation, 1, squeeze));
    }
  }
}

TEST(inertia, tangent_of_every_law_matches_central_differences) {
  for (const auto& [name, law] : composite_laws()) {
    SCOPED_TRACE(name);
    State state(make_material(
        with_inertia(describe_law(small_packing(), law, BoundaryType::periodic_cell))));
    shake(state, 2, 0.3);
    expect_derivative(state, sum(state.committed().deformation, 1, squeeze));
  }
}

TEST(inertia, turns_with_the_increment) {
  const auto material = make_material(with_inertia(describe(small_packing(), rough_law())));
  State straight(material), turned(material);
  Tensor F = identity;
  for (int n = 0; n < 4; ++n) {
    F = sum(F, 1, squeeze);
    for (State* state : {&straight, &turned}) state->set_time_step(0.3 / frequency_of(*material));
    const Tensor Q = rotation(0.9 * (n + 1));
    const Tensor stress = evaluate(straight, F).stress;
    EXPECT_LT(relative_difference(evaluate(turned, product(Q, F)).stress, product(Q, stress)), 1e-7)
        << n;
    straight.commit();
    turned.commit();
  }
}

TEST(inertia, goes_on_from_saved_bytes_and_copies_with_the_same_bits) {
  const auto material = make_material(with_inertia(describe(small_packing(), rough_law())));
  State state(material), loaded(material);
  shake(state, 3, 0.3);
  std::vector<std::byte> bytes(saved_size(*material, state.committed()));
  save_configuration(*material, state.committed(), bytes, state.time_step());
  loaded.restore(load_configuration(*material, std::span<const std::byte>(bytes)));
  State copy(state);
  const Tensor F = sum(state.committed().deformation, 1, squeeze);
  const Evaluation here = evaluate(state, F, TangentKind::exact);
  for (State* other : {&loaded, &copy}) {
    const Evaluation there = evaluate(*other, F, TangentKind::exact);
    EXPECT_EQ(here.stress, there.stress);
    EXPECT_EQ(here.tangent, there.tangent);
    EXPECT_EQ(measure(state, GRAINLAW_KINETIC_ENERGY), measure(*other, GRAINLAW_KINETIC_ENERGY));
  }
}

// From rest, a step far longer than all periods ends in equilibrium.
TEST(inertia, a_long_step_is_equilibrium) {
  State balanced(make_material(describe(small_packing(), rough_law())));
  const Tensor F = sum(identity, 1, squeeze);
  const Tensor equilibrium = evaluate(balanced, F).stress;
  double last = 1;
  for (const double step : {3.0, 100.0, 1e4}) {
    State state(make_material(with_inertia(describe(small_packing(), rough_law()))));
    state.set_time_step(step / frequency_of(state.material()));
    const Evaluation found = evaluate(state, F);
    ASSERT_EQ(found.status, GRAINLAW_OK) << found.report.message;
    const double off = relative_difference(found.stress, equilibrium);
    EXPECT_LT(off, last);
    last = off;
  }
  EXPECT_LT(last, 1e-6);
}

// Where bonds are stiffer than contacts, their period tells what a step resolves.
TEST(inertia, stiff_bonds_that_a_step_does_not_resolve_come_to_rest) {
  ContactLaw law = springy_bonded_law(1e9);
  law.bond.normal_stiffness = 2e10;
  law.bond.tangential_stiffness = 1e10;
  State state(make_material(with_inertia(describe_law(small_packing(), law))));
  const auto& packing = state.material().packing;
  const double mass =
      particle_mass<2>(packing.density, mean_radius(packing.radius), packing.thickness);
  const double period = std::sqrt(mass / 2e10);
  state.set_time_step(5 * period);
  const Tensor F = sum(identity, 1, squeeze);
  advance(state, F);
  const double start = measure(state, GRAINLAW_KINETIC_ENERGY);
  EXPECT_GT(start, 0);
  for (int n = 0; n < 20; ++n) advance(state, F);
  EXPECT_LT(measure(state, GRAINLAW_KINETIC_ENERGY), 1e-6 * start);
}

TEST(inertia, any_time_step_is_solved_from_rest) {
  const auto material = make_material(with_inertia(describe(small_packing(), rough_law())));
  const double period = 1 / frequency_of(*material);
  for (const double step : {1e-300, 1e-9, 1e-6, 1e-3, 0.03, 1.0, 30.0, 1e3, 1e9}) {
    for (const double share : {0.0, 1e-4, 1.0, -1.0, 5.0}) {
      SCOPED_TRACE(std::to_string(step) + ", " + std::to_string(share));
      State state(material);
      state.set_time_step(step * period);
      const Evaluation at = evaluate(state, sum(identity, share, squeeze));
      EXPECT_EQ(at.status, GRAINLAW_OK) << at.report.message;
      if (share == 0) {
        EXPECT_LT(relative_difference(at.stress, state.committed().stress), 1e-6);
      }
    }
  }
}

// Steps far longer than a contact's period lose energy, and gain none.
TEST(inertia, long_steps_are_stable) {
  for (const double step : {1.0, 3.0, 10.0}) {
    SCOPED_TRACE(step);
    State state(make_material(with_inertia(describe(small_packing(), smooth_law()))));
    shake(state, 10, 0.2);
    const Tensor F = state.committed().deformation;
    State balanced(make_material(describe(small_packing(), smooth_law())));
    advance(balanced, F);
    const double at_rest = measure(balanced, GRAINLAW_ELASTIC_ENERGY);
    const auto energy = [&] {
      return measure(state, GRAINLAW_ELASTIC_ENERGY) + measure(state, GRAINLAW_KINETIC_ENERGY) -
             at_rest;
    };
    state.set_time_step(step / frequency_of(state.material()));
    const double start = energy();
    double last = start;
    for (int n = 0; n < 60; ++n) {
      advance(state, F);
      EXPECT_LT(energy(), last + 1e-3 * start) << n;
      last = energy();
    }
    EXPECT_LT(last, start);
  }
}

// Such a step damps all of the motion: what is left is an equilibrium, with no particle pushed through
// another.
TEST(inertia, steps_far_too_long_for_motion_end_it_without_a_gain) {
  for (const double step : {1e2, 1e3}) {
    SCOPED_TRACE(step);
    State state(make_material(with_inertia(describe(small_packing(), smooth_law()))));
    shake(state, 10, 0.5);
    const Tensor F = state.committed().deformation;
    const double kinetic = measure(state, GRAINLAW_KINETIC_ENERGY);
    const double start = measure(state, GRAINLAW_ELASTIC_ENERGY) + kinetic;
    const double overlap = measure(state, GRAINLAW_MEAN_OVERLAP);
    state.set_time_step(step / frequency_of(state.material()));
    for (int n = 0; n < 3; ++n) advance(state, F);
    EXPECT_LT(measure(state, GRAINLAW_KINETIC_ENERGY), 1e-2 * kinetic);
    EXPECT_LT(measure(state, GRAINLAW_ELASTIC_ENERGY), start);
    EXPECT_LT(measure(state, GRAINLAW_MEAN_OVERLAP), 1.5 * overlap);
  }
}

// Bonds that break set energy free. What particles take up as motion is not dissipated too.
TEST(inertia, what_broken_bonds_set_free_counts_once) {
  State state(make_material(with_inertia(describe_law(small_packing(), bonded_law(1)))));
  state.set_time_step(0.2 / frequency_of(state.material()));
  const Packing& packing = state.material().packing;
  const double volume = determinant<2>(packing.cell.data()) * packing.thickness;
  const auto energy = [&] {
    return measure(state, GRAINLAW_ELASTIC_ENERGY) + measure(state, GRAINLAW_KINETIC_ENERGY) +
           measure(state, GRAINLAW_DISSIPATED_ENERGY);
  };
  const double start = energy();
  const Tensor change{0, 0, 0, 2e-5};
  Tensor F = state.committed().deformation, last{};
  double work = 0;
  for (int n = 0; n < 400; ++n) {
    const Evaluation at = evaluate(state, F);
    ASSERT_EQ(at.status, GRAINLAW_OK);
    state.commit();
    if (n > 0) work += 0.5 * volume * inner<2>(sum(at.stress, 1, last), change);
    last = at.stress;
    F = sum(F, 1, change);
  }
  const double dissipated = measure(state, GRAINLAW_DISSIPATED_ENERGY);
  EXPECT_GT(measure(state, GRAINLAW_BROKEN_BONDS), 5);
  EXPECT_NEAR(energy() - start, work, 0.02 * dissipated);
}

TEST(inertia, refuses_what_contradicts_it) {
  const auto message = [](const std::string& boundary, const std::string& solver) -> std::string {
    const std::string text = read_text(grainlaw::test::data_file("rve400.toml")) +
                             "\n[boundary]\n" + boundary + "\n[solver]\ninertia = true\n" + solver;
    try {
      (void)parse_material(text, grainlaw::test::data_folder(), "sand.toml");
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(message("", ""), "");
  for (const auto& [boundary, solver, named] :
       std::vector<std::array<const char*, 3>>{{"", "viscous_number = 1e-3", "viscous_number"},
                                               {"", "method = \"advancing\"", "method"},
                                               {"", "loose_tolerance = 1e-3", "loose_tolerance"},
                                               {"type = \"frame-t\"", "", "under a stress"}}) {
    const std::string told = message(boundary, solver);
    EXPECT_NE(told.find("solver.inertia: found true with"), std::string::npos) << told;
    EXPECT_NE(told.find(named), std::string::npos) << told;
  }
}

TEST(inertia, asks_for_a_time_step) {
  State state(make_material(with_inertia(describe(small_packing(), rough_law()))));
  EXPECT_EQ(evaluate(state, identity).status, GRAINLAW_OK);
  const Tensor F = sum(identity, 1, squeeze);
  EXPECT_THROW(evaluate(state, F), Error);
  state.set_time_step(1e-3);
  EXPECT_EQ(evaluate(state, F).status, GRAINLAW_OK);
}

}  // namespace
}  // namespace grainlaw::core::test

// What every boundary condition promises: the work that forces do on admissible motions, the
// conditions themselves, pure rotations, and the order of their stiffness.
#include "base/error.hpp"
#include "boundary_support.hpp"
#include "material/material_file.hpp"

#include <random>
#include <set>

namespace grainlaw::core::test {
namespace {

constexpr double bar = 1e-8;

// F in ordinary increments; what is bound to axes has nothing to turn.
template <class Visit>
void at_equilibria(const MaterialDescription& description, Visit&& visit) {
  State state(make_material(description));
  const Tensor path[] = {{1.0004, 2e-4, -1e-4, 0.9992}, {1.0004, 0.001, 4e-4, 0.9990}};
  for (const Tensor& F : path) {
    const double angle = state.material().space.bound_to_axes() ? 0 : 0.3;
    advance(state, product(rotation(angle), F));
    visit(state);
  }
}

// Contacts against stress on a random admissible motion, Hill-Mandel in its weak form.
void expect_equal_work(const State& state, std::mt19937& random) {
  const Material& material = state.material();
  const auto& space = material.space;
  const auto n = material.packing.size();
  const Motion motion = random_motion(state, random);
  double work = 0;
  double magnitude = 0;
  for (const auto& c : contact_views(material.problem(), state.current())) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const auto f = force_on_j(c);
    double part = f[0] * (motion.x[j] - motion.x[i]) + f[1] * (motion.x[n + j] - motion.x[n + i]);
    if (material.law.rotating()) {
      const auto& r = material.packing.radius;
      const double lever = r[i] / (r[i] + r[j]);
      part -= c.weight * c.tangential_force[0] * std::hypot(c.branch[0], c.branch[1]) *
              (lever * motion.rotation[i] + (1 - lever) * motion.rotation[j]);
    }
    work -= part / space.reference_volume;
    magnitude += std::abs(part) / space.reference_volume;
  }
  EXPECT_NEAR(work, dot(stress_of(state), motion.deformation), bar * magnitude);
  EXPECT_LE(bar * magnitude, 1e-6 * norm(stress_of(state)));  // the bar means something
}

TEST(boundary_space, forces_work_as_much_as_the_stress) {
  std::mt19937 random(7);
  for (const auto& [name, description] : all_spaces(small_packing())) {
    SCOPED_TRACE(name);
    if (description.boundary.type == BoundaryType::periodic_cell) continue;
    at_equilibria(description, [&](const State& state) {
      for (int k = 0; k < 5; ++k) expect_equal_work(state, random);
    });
  }
}

TEST(boundary_space, boundary_forces_make_the_stress) {  // eq. 23
  for (const auto& [name, description] : all_spaces(small_packing())) {
    SCOPED_TRACE(name);
    if (description.boundary.type == BoundaryType::periodic_cell) continue;
    at_equilibria(description, [](const State& state) {
      EXPECT_LE(relative_difference(stress_of_boundary(state), stress_of(state)), bar);
    });
  }
}

void expect_affine_place(const State& state, int particle) {
  const auto& packing = state.material().packing;
  const auto n = packing.size();
  const auto p = static_cast<std::size_t>(particle);
  const auto& f = state.current().deformation;
  const auto& z = state.current().coordinates;
  const double x = packing.position[p];
  const double y = packing.position[n + p];
  EXPECT_NEAR(z[p], f[0] * x + f[1] * y, 1e-14);
  EXPECT_NEAR(z[n + p], f[2] * x + f[3] * y, 1e-14);
}

TEST(boundary_space, homogeneous_deformation_moves_the_boundary_with_it) {  // eq. 17
  at_equilibria(describe(small_packing(), rough_law(), BoundaryType::frame_d),
                [](const State& state) {
                  const auto& packing = state.material().packing;
                  const auto* turn = state.current().coordinates.data() + 2 * packing.size();
                  for (const int q : packing.frame->boundary) {
                    expect_affine_place(state, q);
                    EXPECT_EQ(turn[q], turn[packing.frame->corner[0]]);
                  }
                });
}

TEST(boundary_space, periodic_fluctuations_leave_the_corners_in_their_affine_place) {  // eq. 20
  at_equilibria(describe(small_packing(), rough_law(), BoundaryType::frame_p),
                [](const State& state) {
                  for (const int corner : state.material().packing.frame->corner) {
                    expect_affine_place(state, corner);
                  }
                });
}

// Liu, Bosco & Suiker (2019), section 4.3.2. Corners turn as one.
TEST(locked_inside, discs_turn_with_the_frame_and_those_of_the_boundary_in_pairs) {
  auto description = describe(small_packing(), rough_law(), BoundaryType::frame_p);
  description.boundary.inner_rotation = InnerRotation::fixed;
  at_equilibria(description, [](const State& state) {
    const auto& packing = state.material().packing;
    const auto& frame = *packing.frame;
    const auto* turn = state.current().coordinates.data() + 2 * packing.size();
    const std::set<int> boundary(frame.boundary.begin(), frame.boundary.end());
    std::set<double> inner, outer;
    for (std::size_t p = 0; p < packing.size(); ++p)
      (boundary.count(static_cast<int>(p)) > 0 ? outer : inner).insert(turn[p]);
    EXPECT_EQ(inner.size(), 1U);
    EXPECT_GT(outer.size(), 3U);
    for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
      if (frame.partner[q] < 0) continue;
      EXPECT_EQ(turn[frame.boundary[q]], turn[frame.partner[q]]);
    }
    for (const int corner : frame.corner) EXPECT_EQ(turn[corner], turn[frame.corner[0]]);
  });
}

TEST(boundary_space, moments_on_the_boundary_make_the_stress_asymmetric) {
  at_equilibria(
      describe(small_packing(), rough_law(), BoundaryType::frame_d), [](const State& state) {
        const auto around = surroundings(state);
        double moments = 0;
        for (const int q : state.material().packing.frame->boundary) {
          moments += around.moment[static_cast<std::size_t>(q)];
        }
        double cauchy[4];
        measure(state.material().problem(), state.current(), GRAINLAW_CAUCHY_STRESS, cauchy);
        const double couple = moments / measure(state, GRAINLAW_VOLUME);
        EXPECT_NEAR(cauchy[1] - cauchy[2], couple, 1e-8 * std::abs(cauchy[3]));
        EXPECT_GT(std::abs(couple), 1e-5 * std::abs(cauchy[3]));
      });
}

TEST(boundary_space, uniform_stress_loads_every_boundary_particle_by_its_area) {  // eqs. 21-22
  at_equilibria(describe(small_packing(), rough_law(), BoundaryType::frame_t),
                [](const State& state) {
                  const auto& packing = state.material().packing;
                  const auto around = surroundings(state);
                  const auto stress = stress_of(state);
                  const double tolerance = 20 * state.material().solver.tolerance * around.scale;
                  for (std::size_t q = 0; q < packing.frame->boundary.size(); ++q) {
                    const auto p = static_cast<std::size_t>(packing.frame->boundary[q]);
                    for (std::size_t i = 0; i < 2; ++i) {
                      const auto& a = packing.frame->area[q];
                      const double force =
                          packing.thickness * (stress[2 * i] * a[0] + stress[2 * i + 1] * a[1]);
                      EXPECT_NEAR(around.force[p][i], force, tolerance);
                    }
                    EXPECT_NEAR(around.moment[p] / packing.radius[p], 0, tolerance);
                  }
                });
}

TEST(boundary_space, boundary_particles_average_to_the_deformation) {  // eqs. 1-2, 15
  for (const auto type : {BoundaryType::frame_d, BoundaryType::frame_t}) {
    at_equilibria(describe(small_packing(), rough_law(), type), [](const State& state) {
      EXPECT_LE(relative_difference(average_deformation(state), deformation_of(state)), 1e-12);
    });
  }
}

TEST(boundary_space, pure_rotation_turns_the_stress) {
  for (const auto& [name, description] : all_spaces(small_packing())) {
    SCOPED_TRACE(name);
    State state(make_material(description));
    if (state.material().space.bound_to_axes()) continue;
    advance(state, {1.0003, 1e-4, 0, 0.9995});
    const Tensor before = stress_of(state);
    const Tensor Q = rotation(0.7);
    const Tensor after = advance(state, product(Q, deformation_of(state))).stress;
    EXPECT_LE(relative_difference(after, product(Q, before)), 1e-10);
  }
}

TEST(boundary_space, homogeneous_is_stiffer_than_periodic_than_uniform_stress) {
  const auto& packing = small_packing();
  double work[3]{};
  const BoundaryType types[] = {BoundaryType::frame_d, BoundaryType::frame_p,
                                BoundaryType::frame_t};
  for (std::size_t k = 0; k < 3; ++k) {
    State state(make_material(describe(packing, rough_law(), types[k])));
    const Tensor start = stress_of(state);
    const Tensor F{1.0002, 4e-4, 4e-4, 0.9994};
    advance(state, F, 2);
    work[k] = dot(sum(stress_of(state), -1, start), sum(F, -1, identity));
  }
  EXPECT_GT(work[0], 1.01 * work[1]);
  EXPECT_GT(work[1], 1.01 * work[2]);
  EXPECT_GT(work[2], 0);
}

TEST(boundary_space, tangent_is_the_derivative) {
  for (const auto& [name, description] : all_spaces(firm_packing())) {
    SCOPED_TRACE(name);
    State state(make_material(description));
    advance(state, {1.0002, 1e-4, 0, 0.9997});
    const Tensor F{1.0003, 1.5e-4, 5e-5, 0.9995};
    const Evaluation at = evaluate(state, F, TangentKind::exact);
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    EXPECT_EQ(at.report.tangent_exact, 1);
    EXPECT_LE(relative_difference(central_differences(state, F, 1e-7), at.tangent), 1e-6);
  }
}

TEST(boundary_space, tangent_through_subincrements_is_the_derivative) {
  for (auto& [name, description] : all_spaces(firm_packing())) {
    SCOPED_TRACE(name);
    description.solver.increment_limit = 1e-3;
    State state(make_material(description));
    const Tensor F{1.0003, 1.5e-4, 5e-5, 0.9995};
    const Evaluation at = evaluate(state, F, TangentKind::exact);
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    EXPECT_GT(at.report.subincrements, 1);
    EXPECT_LE(relative_difference(central_differences(state, F, 1e-7), at.tangent), 1e-6);
  }
}

TEST(boundary_space, saved_state_goes_on_with_the_same_bits) {
  for (const auto& [name, description] : all_spaces(small_packing())) {
    SCOPED_TRACE(name);
    const auto material = make_material(description);
    State state(material);
    advance(state, {1.0003, 1e-4, 0, 0.9995});
    State loaded(material);
    std::vector<std::byte> bytes(saved_size(*material, state.committed()));
    save_configuration(*material, state.committed(), bytes);
    loaded.restore(load_configuration(*material, bytes));
    const Tensor F{1.0004, 2e-4, 0, 0.9993};
    EXPECT_EQ(evaluate(loaded, F).stress, evaluate(state, F).stress);
  }
}

// But for the stresses that are prescribed: a state goes over from one to another.
TEST(boundary_space, saved_states_of_other_spaces_are_refused) {
  std::map<std::string, std::shared_ptr<const Material>> materials;
  for (const auto& [name, description] : all_spaces(small_packing())) {
    materials[name] = make_material(description);
  }
  const auto kind = [](const std::string& name) {
    return name == "layer under a given F" ? "layer" : name;
  };
  for (const auto& [one, a] : materials) {
    for (const auto& [other, b] : materials) {
      EXPECT_EQ(a->fingerprint == b->fingerprint, kind(one) == kind(other)) << one << ", " << other;
    }
  }
}

// Shear beyond friction: the effort, told in the message, is that of a few attempts.
TEST(boundary_space, stress_that_no_state_carries_is_refused_soon) {
  constexpr long bearable = 30000;  // relaxation steps
  const auto description = parse_material(R"(dimension = 2
thickness = 1.1
[packing]
generator = "hexagonal"
columns = 2
rows = 2
radius = 5e-3
pressure = 1e5
[contact]
law = "frictional"
young = 3e8
ratio = 0.8
friction = 0.5
[boundary]
type = "mixed"
left = { x = "P", y = "P", rotation = "periodic" }
right = { x = "P", y = "P", rotation = "periodic" }
bottom = { x = "D", y = "D", rotation = "fixed", row = "rigid" }
top = { x = "D", y = "D", rotation = "free" }
stress = { P12 = -2.5e5 }
)",
                                          ".", "material.toml");
  try {
    make_material(description);
    FAIL() << "a stress that no friction carries was taken";
  } catch (const Error& error) {
    const std::string told = error.what();
    const auto at = told.find("after ");
    ASSERT_NE(at, std::string::npos) << told;
    EXPECT_LT(std::stol(told.substr(at + 6)), bearable) << told;
  }
}

}  // namespace
}  // namespace grainlaw::core::test

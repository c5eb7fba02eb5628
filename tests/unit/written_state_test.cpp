// A state written as a packing is read again, and goes on as it was.
#include "../temporary_directory.hpp"
#include "base/error.hpp"
#include "boundary_support.hpp"
#include "law_support.hpp"
#include "material/packing_file.hpp"
#include "state/output.hpp"
#include "state/rotation.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::core::test {
namespace {

Packing without_contacts(Packing packing) {
  packing.contacts.clear();
  return packing;
}

// dP/dF relative to the configuration at F: dP'/dF' of P' = P F^T / det F and F' = dF F^-1.
Tangent pushed(const Tangent& a, const Tensor& F) {
  const double det = F[0] * F[3] - F[1] * F[2];
  Tangent result{};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t l = 0; l < 2; ++l)
          for (std::size_t m = 0; m < 2; ++m)
            for (std::size_t n = 0; n < 2; ++n)
              result[((2 * i + j) * 2 + k) * 2 + l] +=
                  a[((2 * i + m) * 2 + k) * 2 + n] * F[2 * j + m] * F[2 * l + n] / det;
  return result;
}

Tensor pushed(const Tensor& P, const Tensor& F) {
  Tensor result = product(P, transpose(F));
  for (double& value : result) value /= F[0] * F[3] - F[1] * F[2];
  return result;
}

struct Goal {
  const char* name;
  Tensor deformation;
  double turn = 0;  // on the way [rad]
  int steps = 10;
};

// Sheared far, pressed together, a drained test at its end, and turned on the way.
const Goal sheared{"sheared", {1, 0.6, 0, 1}, 0, 60};
const Goal compressed{"compressed", {0.97, 0, 0, 0.97}};
const Goal flattened{"flattened", {1.1, 0, 0, 0.88}, 0, 24};
const Goal turned{"turned", {0.995, 0.02, 0, 0.99}, 1};

// What a test compared: written states, those led to their goal, and steps after reading.
struct Count {
  int states = 0, at_goal = 0, steps = 0;
};

// Leads as far as there is an equilibrium: some boundaries lose contact before the end. Returns
// whether the goal was reached.
bool lead(State& state, const Goal& goal) {
  for (int k = 1; k <= goal.steps; ++k) {
    const double share = static_cast<double>(k) / goal.steps;
    const Tensor identity{1, 0, 0, 1};
    const Tensor F = sum(identity, share, sum(goal.deformation, -1, identity));
    if (evaluate(state, product(rotation(share * goal.turn), F)).status != GRAINLAW_OK)
      return false;
    state.commit();
  }
  return true;
}

MaterialDescription read_back(const State& state, const std::string& prefix) {
  const Material& material = state.material();
  write_packing(prefix, as_packing(material, state.committed()));
  MaterialDescription again;
  again.packing =
      read_packing({prefix + "_particles.csv", prefix + "_contacts.csv", prefix + "_cell.csv"});
  again.law = material.law;
  again.boundary = material.space.options;
  again.solver = material.solver;
  const Tensor here = pushed(stress_of(state), deformation_of(state));
  for (std::size_t k = 0; k < 4; ++k)
    if (material.space.found[k]) again.boundary.stress[k] = here[k];
  return again;
}

// P and dP/dF of what was read are those of the state, there and after another step, which is counted.
void expect_goes_on(State& state, const std::string& name, Count& count) {
  constexpr double close = 1e-9;      // the solver's tolerance is 1e-10
  constexpr double amplified = 1e-6;  // by what is nearly singular
  const TemporaryDirectory directory;
  State read(make_material(read_back(state, directory / "p")));
  const Tensor F = deformation_of(state);
  EXPECT_LE(relative_difference(stress_of(read), pushed(stress_of(state), F)), close) << name;
  ++count.states;
  // A component of P that is kept is another one once the axes it counts by are deformed.
  const auto& found = state.material().space.found;
  if ((found[0] || found[3]) && (F[1] != 0 || F[2] != 0)) return;
  const Tensor step{1.00002, 0, 0, 0.99997};
  const Evaluation a = evaluate(state, product(step, F), TangentKind::exact);
  const Evaluation b = evaluate(read, step, TangentKind::exact);
  ASSERT_EQ(a.status, b.status) << name;
  if (a.status != GRAINLAW_OK) return;
  EXPECT_LE(relative_difference(b.stress, pushed(a.stress, F)), amplified) << name;
  EXPECT_LE(relative_difference(b.tangent, pushed(a.tangent, F)), amplified) << name;
  ++count.steps;
}

void expect_all_go_on(MaterialDescription description, const ContactLaw& law,
                      const std::string& name, const std::vector<Goal>& goals, Count& count) {
  description.law = law;
  if (law.hertzian()) description.packing.contacts.clear();
  const auto material = make_material(description);
  for (const Goal& goal : goals) {
    State state(material);
    if (lead(state, goal)) ++count.at_goal;
    expect_goes_on(state, name + ", " + goal.name, count);
  }
}

TEST(written_state, goes_on_as_it_was_under_every_boundary) {
  Count count;
  for (const auto& [name, description] : all_spaces(small_packing()))
    expect_all_go_on(description, description.law, name, {sheared, compressed, flattened, turned},
                     count);
  EXPECT_EQ(count.states, 44);
  EXPECT_GE(count.at_goal, 36);  // 38 of GCC 12
  EXPECT_GE(count.steps, 32);    // 34
}

TEST(written_state, goes_on_as_it_was_with_every_law) {
  Count count;
  const auto all = all_spaces(small_packing());
  for (const NamedLaw& law : {NamedLaw{"rolling", rolling_law()},
                              {"Hertz-Mindlin, rolling", rolling_hertz_law()},
                              {"bonds that hold", bonded_law(100)},
                              {"bonds that break", bonded_law(1)}})
    for (const auto& [name, description] : all)
      if (name == "periodic-cell" || name == "frame-d" || name == "frame-t" ||
          name == "layer between rows")
        expect_all_go_on(description, law.law, std::string(law.name) + ", " + name,
                         {sheared, turned}, count);
  EXPECT_EQ(count.states, 32);
  EXPECT_GE(count.at_goal, 26);  // 28 of GCC 12
  EXPECT_GE(count.steps, 22);    // 24
}

TEST(written_state, may_be_written_and_read_again_and_again) {
  Count count;
  const auto all = all_spaces(small_packing());
  for (const auto& [name, description] : all) {
    if (name != "frame-t" && name != "layer between rows") continue;
    State first(make_material(description));
    EXPECT_TRUE(lead(first, compressed)) << name;
    const TemporaryDirectory directory;
    State second(make_material(read_back(first, directory / "a")));
    EXPECT_TRUE(lead(second, {"sheared", {1, 0.02, 0, 0.99}})) << name;
    expect_goes_on(second, name, count);
  }
  EXPECT_EQ(count.states, 2);
  EXPECT_EQ(count.steps, 1);  // not of the layer, whose P is kept along axes that were sheared
}

// A bond of soft discs, drawn to almost twice its length.
TEST(written_state, keeps_bonds_that_are_stretched) {
  ContactLaw law = bonded_law(1e6);
  law.young = 6e6;
  const MaterialDescription description = describe_law(without_contacts(small_packing()), law);
  State state(make_material(description));
  lead(state, {"stretched", {1.8, 0, 0, 1.2}, 0, 40});
  EXPECT_GT(deformation_of(state)[0], 1.7);
  Count count;
  expect_goes_on(state, "stretched bonds", count);
  EXPECT_EQ(count.steps, 1);
}

// With all bonds broken and no contact left to say so, none is made anew of discs that touch.
TEST(written_state, keeps_bonds_that_are_broken) {
  const TemporaryDirectory directory;
  Packing packing = without_contacts(small_packing());
  packing.names_bonds = true;
  const std::string prefix = directory / "p";
  write_packing(prefix, packing);
  const Packing read =
      read_packing({prefix + "_particles.csv", prefix + "_contacts.csv", prefix + "_cell.csv"});
  const auto material = make_material(describe(read, bonded_law(100)));
  EXPECT_FALSE(material->initial.contacts.empty());
  for (const auto& contact : material->initial.contacts) EXPECT_FALSE(contact.bonded);
}

// Any basis of the same lattice is the same packing, also where the cell looks far thinner than a disc.
TEST(written_state, may_have_any_basis_of_its_lattice) {
  const TemporaryDirectory directory;
  const Packing packing = small_packing();
  const Tensor expected = stress_of(State(make_material(describe(packing, rough_law()))));
  for (const auto& [k, l] : {std::pair{1, 0}, {0, -3}, {7, 0}, {-40, 2}, {3000, 0}, {0, 20000}}) {
    // a' = a + l b', b' = b + k a; shifts count the other way.
    Packing other = packing;
    auto& h = other.cell;
    for (std::size_t row = 0; row < 2; ++row) {
      h[2 * row + 1] += k * h[2 * row];
      h[2 * row] += l * h[2 * row + 1];
    }
    for (auto& contact : other.contacts) {
      auto& s = contact.shift;
      s[0] -= k * s[1];
      s[1] -= l * s[0];
    }
    const std::string prefix = directory / "p";
    write_packing(prefix, other);
    const Packing read =
        read_packing({prefix + "_particles.csv", prefix + "_contacts.csv", prefix + "_cell.csv"});
    EXPECT_LE(
        relative_difference(stress_of(State(make_material(describe(read, rough_law())))), expected),
        1e-8)
        << k << " " << l;
  }
}

TEST(written_state, that_nothing_could_start_from_is_refused_and_writes_nothing) {
  const TemporaryDirectory directory;
  Packing crushed = small_packing();
  crushed.contacts.clear();
  const std::size_t n = crushed.size();
  crushed.position[1] = crushed.position[0] + 0.1 * crushed.radius[0];
  crushed.position[n + 1] = crushed.position[n];
  try {
    write_packing(directory / "p", crushed);
    ADD_FAILURE() << "written";
  } catch (const Error& error) {
    EXPECT_EQ(error.status, GRAINLAW_BAD_PACKING);
    EXPECT_NE(std::string(error.what()).find("p_particles.csv: particles 0 and 1"),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(directory / "p_particles.csv"));
}

}  // namespace
}  // namespace grainlaw::core::test

// Discs in a row that closes on itself, whose contacts slide: where they turn to is known.
#include "equilibrium/rolling_mechanisms.hpp"
#include "disc_row.hpp"
#include "law_support.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double overlap = 1e-6;
constexpr double angle = 5e-4;  // of the row after the shear, against before

// After a shear that turns the row, nothing yet in equilibrium.
struct Sheared {
  State state;
  Problem problem;
  Increment increment;
  Stiffness stiffness;
  RollingMechanisms mechanisms;

  explicit Sheared(const std::vector<double>& radii)
      : state(make_material(describe(disc_row(radii, overlap), rough_law()))),
        problem(state.material().problem()) {
    increment.begin(problem, state.committed(), {1, 0, std::tan(angle), 1});
    increment.refresh_masses();
    increment.update_forces();
  }

  // Those that are out of balance, by a step with all held.
  bool turn(double least) {
    find();
    mechanisms.regularise(increment, stiffness);
    stiffness.factorise(increment);
    const auto r = increment.residual();
    std::vector<double> step(r.size());
    EXPECT_TRUE(stiffness.solve(increment, r, step));
    mechanisms.see(increment, step, least);
    return turn_seen(least);
  }
  bool turn_all(double least) {
    find();
    mechanisms.see(increment, std::vector<double>(increment.problem().unknowns(), 1.0), 0);
    return turn_seen(least);
  }
  [[nodiscard]] double moment(std::size_t p) const {  // as a force on the surface
    return increment.residual()[2 * increment.problem().nodes() + p] /
           increment.motion().node_radius()[p];
  }
  [[nodiscard]] double turned(std::size_t p) const {  // length along the surface
    return increment.motion().coordinates()[2 * increment.problem().nodes() + p] *
           increment.motion().node_radius()[p];
  }
  [[nodiscard]] ContactPoint point(std::size_t c) const {
    return contact_point(increment.contacts(), c, increment.motion().coordinates(),
                         increment.problem().particles(), *problem.law);
  }
  [[nodiscard]] std::size_t contact(int i, int j) const {
    const auto& list = increment.contacts();
    for (std::size_t c = 0; c < list.size(); ++c) {
      if (list.i[c] == i && list.j[c] == j && point(c).status != ContactStatus::open) return c;
    }
    ADD_FAILURE() << "no contact of " << i << " and " << j;
    return 0;
  }

 private:
  void find() {
    stiffness.assemble(increment, 0);
    mechanisms.find(increment, stiffness.touching());
  }
  bool turn_seen(double least) {
    const bool turned = mechanisms.rotate(increment, least);
    increment.update_forces();
    return turned;
  }
};

// The larger disc slides on both others, which stick: their contact is shorter.
struct Pair : Sheared {
  std::size_t stuck;

  Pair() : Sheared({0.5e-3, 0.5e-3, 2e-3}) {
    increment.motion().coordinate(0, 2) -= 0.1 * overlap;  // its contacts carry different forces
    increment.update_forces();
    stuck = contact(0, 1);
    EXPECT_EQ(point(stuck).status, ContactStatus::sticking);
    for (const int other : {0, 1}) {
      EXPECT_EQ(point(contact(other, 2)).status, ContactStatus::sliding);
    }
  }
  [[nodiscard]] double pull() const { return std::abs(moment(0) - moment(1)); }
};

TEST(mechanisms, a_disc_that_slides_on_all_others_turns_to_where_its_moment_vanishes) {
  Sheared sheared({1e-3, 1e-3});
  const std::vector<double> places = sheared.increment.motion().coordinates();
  ASSERT_EQ(sheared.point(0).status, ContactStatus::sliding);
  const double before = std::abs(sheared.moment(0));
  EXPECT_GT(before, 0);
  EXPECT_TRUE(sheared.turn(1e-6 * before));
  // Both contacts slip back to where they began.
  EXPECT_NEAR(sheared.turned(0), 2e-3 * angle, 1e-6 * 2e-3 * angle);
  EXPECT_EQ(sheared.turned(1), 0);
  for (const std::size_t p : {0U, 1U}) {
    EXPECT_LT(std::abs(sheared.moment(p)), 1e-9 * before);
    for (const std::size_t k : {p, 2 + p}) {
      EXPECT_EQ(sheared.increment.motion().coordinates()[k], places[k]);
    }
  }
}

TEST(mechanisms, discs_that_stick_to_each_other_alone_turn_against_each_other) {
  Pair pair;
  const double force = pair.point(pair.stuck).tangential_force;
  EXPECT_TRUE(pair.turn_all(0.5 * pair.pull()));
  EXPECT_NE(pair.turned(0), 0);
  EXPECT_EQ(pair.turned(0), -pair.turned(1));
  EXPECT_NEAR(pair.point(pair.stuck).tangential_force, force, 1e-9 * std::abs(force));
}

// The pull on the pair ends once the larger disc is in the middle again; that on the larger disc does not.
TEST(mechanisms, what_other_motions_balance_is_left_to_them) {
  Pair pair;
  EXPECT_TRUE(pair.turn(0.5 * pair.pull()));
  EXPECT_NE(pair.turned(2), 0);
  EXPECT_EQ(pair.turned(0), 0);
  EXPECT_EQ(pair.turned(1), 0);
}

TEST(mechanisms, nothing_turns_for_less_than_asked_or_where_it_is_in_balance) {
  Sheared sheared({1e-3, 1e-3});
  const std::vector<double> places = sheared.increment.motion().coordinates();
  EXPECT_FALSE(sheared.turn(2 * std::abs(sheared.moment(0))));
  EXPECT_EQ(sheared.increment.motion().coordinates(), places);
  const double least = 1e-9 * std::abs(sheared.moment(0));
  EXPECT_TRUE(sheared.turn(least));
  EXPECT_FALSE(sheared.turn(least));
}

// Turning needs rotations, and forces that a rotation alone can leave as they are.
TEST(mechanisms, are_none_where_discs_keep_their_orientation_or_contacts_carry_moments) {
  const Packing packing = disc_row({1e-3, 1e-3}, overlap);
  for (const auto& [law, possible] :
       {std::pair{rough_law(), true}, std::pair{hertz_law(), true},
        std::pair{compressive_law(), false}, std::pair{bonded_law(1e6), false}}) {
    const State state(make_material(describe(packing, law)));
    EXPECT_EQ(RollingMechanisms::possible(state.material().problem()), possible);
  }
}

}  // namespace
}  // namespace grainlaw::core::test

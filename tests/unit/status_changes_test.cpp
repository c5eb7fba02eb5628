// What a report says of the contacts between the committed state and the trial.
#include "firm_packing.hpp"
#include "law_support.hpp"

#include <map>

namespace grainlaw::core::test {
namespace {

struct Changes {
  int opened = 0, closed = 0, slid = 0, stuck = 0, broke = 0;
  int touched = 0;  // contacts that any of it happened to
};

Changes changes_since(const Configuration& before, const Configuration& after) {
  using Contact = std::tuple<int, int, int, int>;
  const auto contacts_of = [](const Configuration& configuration) {
    std::map<Contact, ContactHistory> all;
    for (const auto& c : configuration.contacts) all[{c.i, c.j, c.shift[0], c.shift[1]}] = c;
    return all;
  };
  const auto was = contacts_of(before);
  const auto is = contacts_of(after);
  Changes changes;
  for (const auto& [contact, old] : was) {
    const auto found = is.find(contact);
    if (found == is.end()) {
      ++changes.opened;
      ++changes.touched;
      continue;
    }
    const auto& now = found->second;
    changes.slid += !old.sliding && now.sliding ? 1 : 0;
    changes.stuck += old.sliding && !now.sliding ? 1 : 0;
    changes.broke += old.bonded && !now.bonded ? 1 : 0;
    changes.touched += old.sliding != now.sliding || old.bonded != now.bonded ? 1 : 0;
  }
  for (const auto& entry : is) changes.closed += was.count(entry.first) == 0 ? 1 : 0;
  changes.touched += changes.closed;
  return changes;
}

TEST(status_changes, are_the_contacts_that_opened_closed_slid_or_stuck) {
  State state(make_material(describe(reference_packing(), rough_law())));
  advance(state, {1, 0.004, 0.001, 0.999}, 5);
  // Back: what slid sticks.
  const Evaluation at = evaluate(state, {1, 0.001, 0.001, 0.997});
  ASSERT_EQ(at.status, GRAINLAW_OK);
  const Changes changes = changes_since(state.committed(), state.current());
  EXPECT_GT(changes.opened, 0);
  EXPECT_GT(changes.closed, 0);
  EXPECT_GT(changes.slid, 0);
  EXPECT_GT(changes.stuck, 0);
  EXPECT_EQ(at.report.status_changes, changes.touched);
  EXPECT_EQ(at.report.contacts - static_cast<int>(state.committed().contacts.size()),
            changes.closed - changes.opened);
  EXPECT_EQ(at.report.sliding, sliding_contacts(state.current()));
}

TEST(status_changes, are_none_where_nothing_moves) {
  State state(make_material(describe(firm_packing(), rough_law())));
  advance(state, {1, 0.004, 0.001, 0.999}, 5);
  const Tensor here{1, 0.004, 0.001, 0.999};
  EXPECT_EQ(evaluate(state, here).report.status_changes, 0);
}

TEST(status_changes, are_all_contacts_where_the_packing_comes_apart) {
  auto description = describe(small_packing(), rough_law());
  description.solver.contacts_lost = ContactsLost::stress_free;
  State state(make_material(description));
  const Evaluation at = evaluate(state, {1.1, 0, 0, 1.1});
  ASSERT_EQ(at.status, GRAINLAW_OK);
  EXPECT_EQ(at.report.contacts, 0);
  EXPECT_EQ(at.report.status_changes, static_cast<int>(state.committed().contacts.size()));
}

TEST(status_changes, include_bonds_that_break) {
  State state(make_material(describe_law(small_packing(), bonded_law(1))));
  const Evaluation at = evaluate(state, {1.002, 0.008, 0, 0.996});
  ASSERT_EQ(at.status, GRAINLAW_OK);
  const Changes changes = changes_since(state.committed(), state.current());
  EXPECT_GT(changes.broke, 0);
  EXPECT_EQ(at.report.status_changes, changes.touched);
}

}  // namespace
}  // namespace grainlaw::core::test

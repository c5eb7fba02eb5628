// Filling of reports.
#pragma once

#include <grainlaw/grainlaw.h>
#include "base/constants.hpp"
#include "equilibrium/request.hpp"
#include "increment/increment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace grainlaw::core {

inline void describe(grainlaw_report& report, const char* text) {
  std::snprintf(report.message, sizeof report.message, "%s", text);
}

// Number of contacts that opened, closed, lost their bond, or began or ceased to slide.
template <int D>
int status_changes(const Configuration<D>& before, const Configuration<D>& after) {
  auto a = before.contacts.begin();
  int changes = 0;
  for (const auto& contact : after.contacts) {
    for (; a != before.contacts.end() && key_of(*a) < key_of(contact); ++a) ++changes;
    const bool known = a != before.contacts.end() && key_of(*a) == key_of(contact);
    if (!known || a->sliding != contact.sliding || a->bonded != contact.bonded) ++changes;
    if (known) ++a;
  }
  return changes + static_cast<int>(before.contacts.end() - a);
}

template <int D>
void add_cost(const Increment<D>& increment, grainlaw_report& report) {
  report.relaxation_steps += increment.cost.relaxation_steps;
  report.servo_corrections += increment.cost.servo_corrections;
  report.factorisations += increment.cost.factorisations;
}

// Size and work of the drag, and a warning where it carries part of the load.
template <int D>
void add_drag(const Increment<D>& increment, grainlaw_report& report) {
  const auto& drag = increment.motion().drag();
  if (!drag.acts()) return;
  report.unbalanced = drag.largest(increment.motion().records()) / increment.scale().relative();
  report.viscous_work = increment.losses().dragged();
  if (report.unbalanced > tuned::much_drag && !drag.has_inertia()) {
    describe(report,
             "drag carries part of the load (unbalanced above 0.1); a smaller "
             "solver.viscous_number lowers it");
  }
}

// Cost, residual and drag of an increment, whether it was solved or not.
template <int D>
void add_outcome(const Increment<D>& increment, const Outcome& outcome, grainlaw_report& report) {
  add_cost(increment, report);
  report.step_ratio = outcome.step_ratio;
  report.subincrements = outcome.subincrements;
  report.history_advanced = outcome.history_advanced ? 1 : 0;
  report.residual = increment.residual_norm();
  add_drag(increment, report);
}

// Number of nodes with a contact now and none before. `marks`: memory for the nodes that had one.
template <int D>
int newly_loaded(const BoundarySpace<D>& space, const Configuration<D>& before,
                 const Configuration<D>& after, std::vector<unsigned char>& marks) {
  marks.assign(space.nodes, 0);
  int count = 0;
  const auto mark = [&](const Configuration<D>& at, int counts) {
    for (const auto& contact : at.contacts) {
      for (const auto p : {contact.i, contact.j}) {
        auto& marked = marks[static_cast<std::size_t>(space.node[static_cast<std::size_t>(p)])];
        count += marked == 0 ? counts : 0;
        marked = 1;
      }
    }
  };
  mark(before, 0);
  mark(after, 1);
  return count;
}

// Counts of contacts and bonds at the end of an increment.
template <int D>
void add_contacts(const Increment<D>& increment, const Configuration<D>& before,
                  const Configuration<D>& after, grainlaw_report& report) {
  report.broken_bonds = static_cast<int>(std::lround(increment.losses().broken_bonds()));
  report.contacts = static_cast<int>(after.contacts.size());
  report.sliding = static_cast<int>(std::count_if(after.contacts.begin(), after.contacts.end(),
                                                  [](const auto& c) { return c.sliding; }));
  report.status_changes = status_changes(before, after);
}

}  // namespace grainlaw::core

#include "contact/frictional.hpp"

#include "contact/composite.hpp"
#include "contact/contact_loops.hpp"

namespace grainlaw {

namespace {

using namespace contact_loops;

constexpr Features frictionless_law{Kinematics::frictionless};
constexpr Features locked_law{Kinematics::locked};
constexpr Features rotating_law{Kinematics::rotating};

GRAINLAW_LOOP(LoopResult, frictionless, contact_loop, frictionless_law, false, false)
GRAINLAW_LOOP(LoopResult, locked_near, contact_loop, locked_law, false, false)
GRAINLAW_LOOP(LoopResult, locked_far, contact_loop, locked_law, true, false)
GRAINLAW_LOOP(LoopResult, locked_advancing, contact_loop, locked_law, true, true)
GRAINLAW_LOOP(LoopResult, rotating_near, contact_loop, rotating_law, false, false)
GRAINLAW_LOOP(LoopResult, rotating_far, contact_loop, rotating_law, true, false)
GRAINLAW_LOOP(LoopResult, rotating_advancing, contact_loop, rotating_law, true, true)
GRAINLAW_LOOP(ContactTotals, stiffnesses, stiffness_loop, rotating_law)

}  // namespace

void find_contact_forces(std::span<const ParticleRecord> particles, const ContactLaw& law,
                         ContactList& list) {
  const Loop loop{particles.data(), law.friction, &list};
  if (!law.tangential()) {
    frictionless(loop);
  } else {
    if (!list.turns_far) {
      list.turns_far = (law.rotating() ? rotating_near(loop) : locked_near(loop)).beyond > 0;
    }
    if (list.turns_far) law.rotating() ? rotating_far(loop) : locked_far(loop);
  }
}

void evaluate_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                       ContactList& list, std::span<ForceRecord> forces) {
  if (!law.plain()) return evaluate_composite(particles, law, list, forces);
  find_contact_forces(particles, law, list);
  list.sums.add_up(list.forces, opposite, forces);
}

double advance_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                        ContactList& list, std::span<ForceRecord> forces) {
  if (!law.tangential()) {
    evaluate_contacts(particles, law, list, forces);
    return 0;
  }
  if (!law.plain()) return advance_composite(particles, law, list, forces);
  const Loop loop{particles.data(), law.friction, &list};
  list.turns_far = false;
  const auto result = law.rotating() ? rotating_advancing(loop) : locked_advancing(loop);
  list.sums.add_up(list.forces, opposite, forces);
  return result.dissipated;
}

ContactTotals sum_stiffnesses(std::span<const ParticleRecord> particles, const ContactLaw& law,
                              ContactList& list, std::span<ForceRecord> sums) {
  if (!law.plain()) return sum_composite_stiffnesses(particles, law, list, sums);
  const auto totals = stiffnesses({particles.data(), 0, &list});
  list.sums.add_up(list.forces, {1, 1, 1, 1}, sums);
  return totals;
}

}  // namespace grainlaw

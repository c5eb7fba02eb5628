#include "contact/composite.hpp"

#include "contact/contact_loops.hpp"

namespace grainlaw {

namespace {

using namespace contact_loops;

// The loops of one law.
struct Loops {
  LoopResult (*near)(const Loop&);
  LoopResult (*far)(const Loop&);
  LoopResult (*advancing)(const Loop&);
  ContactTotals (*stiffnesses)(const Loop&);
};

#define GRAINLAW_LAW(name, ...)                                               \
  constexpr Features name{__VA_ARGS__};                                       \
  GRAINLAW_LOOP(LoopResult, name##_near, contact_loop, name, false, false)    \
  GRAINLAW_LOOP(LoopResult, name##_far, contact_loop, name, true, false)      \
  GRAINLAW_LOOP(LoopResult, name##_advancing, contact_loop, name, true, true) \
  GRAINLAW_LOOP(ContactTotals, name##_stiffnesses, stiffness_loop, name)      \
  constexpr Loops name##_loops{name##_near, name##_far, name##_advancing, name##_stiffnesses};
//                                            hertz  bonds  moments
GRAINLAW_LAW(rolling, Kinematics::rotating, false, false, true)
GRAINLAW_LAW(bonded_locked, Kinematics::locked, false, true, false)
GRAINLAW_LAW(bonded, Kinematics::rotating, false, true, true)
GRAINLAW_LAW(hertz_locked, Kinematics::locked, true, false, false)
GRAINLAW_LAW(hertz, Kinematics::rotating, true, false, false)
GRAINLAW_LAW(hertz_rolling, Kinematics::rotating, true, false, true)

constexpr Features hertz_smooth{Kinematics::frictionless, true, false, false};
GRAINLAW_LOOP(LoopResult, hertz_smooth_near, contact_loop, hertz_smooth, false, false)
GRAINLAW_LOOP(ContactTotals, hertz_smooth_stiffnesses, stiffness_loop, hertz_smooth)
constexpr Loops hertz_smooth_loops{hertz_smooth_near, hertz_smooth_near, hertz_smooth_near,
                                   hertz_smooth_stiffnesses};

const Loops& loops_of(const ContactLaw& law) {
  if (law.bonds()) return law.moments() ? bonded_loops : bonded_locked_loops;
  if (!law.hertzian()) return rolling_loops;
  if (!law.tangential()) return hertz_smooth_loops;
  if (!law.rotating()) return hertz_locked_loops;
  return law.moments() ? hertz_rolling_loops : hertz_loops;
}

// Moments of rolling and bending, gathered in the fourth lane, become part of M / R. What stands
// behind the nodes, for F, has none.
void add_moments(const ContactList& list, std::span<ForceRecord> nodes) {
  for (std::size_t q = 0; q < list.inverse_node_radius.size(); ++q) {
    nodes[q].roll += nodes[q].unused * list.inverse_node_radius[q];
    nodes[q].unused = 0;
  }
}

void gather(const ContactLaw& law, const ContactList& list, std::span<ForceRecord> nodes) {
  list.sums.add_up(list.forces, opposite, nodes);
  if (law.moments()) add_moments(list, nodes);
}

}  // namespace

void evaluate_composite(std::span<const ParticleRecord> particles, const ContactLaw& law,
                        ContactList& list, std::span<ForceRecord> nodes) {
  const Loop loop{particles.data(), law.friction, &list};
  const Loops& loops = loops_of(law);
  if (!list.turns_far) list.turns_far = loops.near(loop).beyond > 0;
  if (list.turns_far) loops.far(loop);
  gather(law, list, nodes);
}

double advance_composite(std::span<const ParticleRecord> particles, const ContactLaw& law,
                         ContactList& list, std::span<ForceRecord> nodes) {
  const Loop loop{particles.data(), law.friction, &list};
  list.turns_far = false;
  const auto result = loops_of(law).advancing(loop);
  gather(law, list, nodes);
  return result.dissipated;
}

ContactTotals sum_composite_stiffnesses(std::span<const ParticleRecord> particles,
                                        const ContactLaw& law, ContactList& list,
                                        std::span<ForceRecord> nodes) {
  const auto totals = loops_of(law).stiffnesses({particles.data(), 0, &list});
  list.sums.add_up(list.forces, {1, 1, 1, 1}, nodes);
  if (law.moments()) add_moments(list, nodes);
  return totals;
}

}  // namespace grainlaw

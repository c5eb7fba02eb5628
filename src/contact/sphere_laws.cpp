#include "contact/contact_forces.hpp"
#include "contact/law_table.hpp"
#include "contact/sphere_loops.hpp"

namespace grainlaw::core {

namespace {

using namespace sphere_loops;

// Loops of one law.
struct Law {
  double (*forces)(const Loop&);
  double (*advancing)(const Loop&);
  ContactTotals (*stiffnesses)(const Loop&);
};

#define GRAINLAW_SPHERE_LAW(name, ...)                                                \
  constexpr Features name##_law{__VA_ARGS__};                                         \
  GRAINLAW_SPHERE_LOOP(double, name##_forces, contact_loop, name##_law, false)        \
  GRAINLAW_SPHERE_LOOP(double, name##_advancing, contact_loop, name##_law, true)      \
  GRAINLAW_SPHERE_LOOP(ContactTotals, name##_stiffnesses, stiffness_loop, name##_law) \
  constexpr Law name{name##_forces, name##_advancing, name##_stiffnesses};
//                                   tangential  rotating  hertz  bonds  moments
GRAINLAW_SPHERE_LAW(smooth, false, false, false)
GRAINLAW_SPHERE_LAW(locked, true, false, false)
GRAINLAW_SPHERE_LAW(rotating, true, true, false)
GRAINLAW_SPHERE_LAW(hertz_smooth, false, false, true)
GRAINLAW_SPHERE_LAW(hertz_locked, true, false, true)
GRAINLAW_SPHERE_LAW(hertz, true, true, true)
GRAINLAW_SPHERE_LAW(rolling, true, true, false, false, true)
GRAINLAW_SPHERE_LAW(hertz_rolling, true, true, true, false, true)
GRAINLAW_SPHERE_LAW(bonded_locked, true, false, false, true, false)
GRAINLAW_SPHERE_LAW(bonded, true, true, false, true, true)

constexpr LawTable<Law> laws{smooth, locked,       rotating,     rolling, bonded_locked,
                             bonded, hertz_smooth, hertz_locked, hertz,   hertz_rolling};

// Sums forces onto nodes. Moments of rolling and bending, summed separately, become part of M / R.
// Rows of F after the nodes have no moments.
void gather(const ContactLaw& law, ContactList<3>& list, std::span<ForceRecord<3>> nodes) {
  list.sums.add_up(list.forces, opposite<3>, nodes);
  if (!law.moments()) return;
  constexpr ForceRecord<3> other_way{-1, -1, -1, -1, -1, -1, {}};
  list.sums.add_up(list.moments, other_way, list.node_moments);
  for (std::size_t q = 0; q < list.inverse_node_radius.size(); ++q) {
    nodes[q].spin_x += list.node_moments[q].x * list.inverse_node_radius[q];
    nodes[q].spin_y += list.node_moments[q].y * list.inverse_node_radius[q];
    nodes[q].spin_z += list.node_moments[q].z * list.inverse_node_radius[q];
  }
}

}  // namespace

template <>
void find_contact_forces<3>(std::span<const ParticleRecord<3>> particles, const ContactLaw& law,
                            ContactList<3>& list) {
  laws.of(law).forces({particles.data(), law.friction, &list});
}

template <>
void evaluate_contacts<3>(std::span<const ParticleRecord<3>> particles, const ContactLaw& law,
                          ContactList<3>& list, std::span<ForceRecord<3>> nodes) {
  find_contact_forces<3>(particles, law, list);
  gather(law, list, nodes);
}

template <>
double advance_contacts<3>(std::span<const ParticleRecord<3>> particles, const ContactLaw& law,
                           ContactList<3>& list, std::span<ForceRecord<3>> nodes) {
  const double dissipated = laws.of(law).advancing({particles.data(), law.friction, &list});
  gather(law, list, nodes);
  return dissipated;
}

template <>
ContactTotals sum_stiffnesses<3>(std::span<const ParticleRecord<3>> particles,
                                 const ContactLaw& law, ContactList<3>& list,
                                 std::span<StiffnessRecord<3>> nodes) {
  const auto totals = laws.of(law).stiffnesses({particles.data(), 0, &list});
  list.sums.add_up(list.stiffness, nodes);
  if (!law.moments()) return totals;
  for (std::size_t q = 0; q < list.inverse_node_radius.size(); ++q) {
    const double rotational = nodes[q].bending * list.inverse_node_radius[q];
    nodes[q].spin_x += rotational;
    nodes[q].spin_y += rotational;
    nodes[q].spin_z += rotational;
  }
  return totals;
}

}  // namespace grainlaw::core

#include "contact/disc_laws.hpp"

#include "contact/contact_forces.hpp"
#include "contact/law_table.hpp"

namespace grainlaw::core {

namespace {

using namespace disc_loops;

constexpr LawTable<Law> laws{smooth, locked,       rotating,     rolling, bonded_locked,
                             bonded, hertz_smooth, hertz_locked, hertz,   hertz_rolling};

// Sums forces onto nodes. Moments of rolling and bending, summed separately, become part of M / R.
// Rows of F after the nodes have no moments.
void gather(const ContactLaw& law, const ContactList<2>& list, std::span<ForceRecord<2>> nodes) {
  list.sums.add_up(list.forces, opposite<2>, nodes);
  if (!law.moments()) return;
  for (std::size_t q = 0; q < list.inverse_node_radius.size(); ++q) {
    nodes[q].roll += nodes[q].moment * list.inverse_node_radius[q];
    nodes[q].moment = 0;
  }
}

}  // namespace

template <>
void find_contact_forces<2>(std::span<const ParticleRecord<2>> particles, const ContactLaw& law,
                            ContactList<2>& list) {
  const Loop loop{particles.data(), law.friction, &list};
  const Law& loops = laws.of(law);
  if (!list.rotates_far) list.rotates_far = loops.near(loop).beyond > 0;
  if (list.rotates_far) loops.far(loop);
}

template <>
void evaluate_contacts<2>(std::span<const ParticleRecord<2>> particles, const ContactLaw& law,
                          ContactList<2>& list, std::span<ForceRecord<2>> nodes) {
  find_contact_forces<2>(particles, law, list);
  gather(law, list, nodes);
}

template <>
double advance_contacts<2>(std::span<const ParticleRecord<2>> particles, const ContactLaw& law,
                           ContactList<2>& list, std::span<ForceRecord<2>> nodes) {
  if (!law.tangential()) {
    evaluate_contacts<2>(particles, law, list, nodes);
    return 0;
  }
  list.rotates_far = false;
  const auto result = laws.of(law).advancing({particles.data(), law.friction, &list});
  gather(law, list, nodes);
  return result.dissipated;
}

template <>
ContactTotals sum_stiffnesses<2>(std::span<const ParticleRecord<2>> particles,
                                 const ContactLaw& law, ContactList<2>& list,
                                 std::span<StiffnessRecord<2>> nodes) {
  const auto totals = laws.of(law).stiffnesses({particles.data(), 0, &list});
  list.sums.add_up(list.stiffness, nodes);
  if (!law.moments()) return totals;
  for (std::size_t q = 0; q < list.inverse_node_radius.size(); ++q) {
    nodes[q].roll += nodes[q].bending * list.inverse_node_radius[q];
    nodes[q].bending = 0;
  }
  return totals;
}

}  // namespace grainlaw::core

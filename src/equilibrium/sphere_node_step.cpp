#include "equilibrium/node_step.hpp"

namespace grainlaw::core::node_step {

namespace {

using OfSpheres = StepMeasures;

// Renews 1 / (2 sqrt(1 + theta^2 / 4)) of the record at z after its eta changed.
GRAINLAW_INLINE void renew_half(double* z) {
  const double eta_square = z[3] * z[3] + z[4] * z[4] + z[5] * z[5];
  z[6] = 0.5 / __builtin_sqrt(1 + 0.25 * eta_square / (z[7] * z[7]));
}

}  // namespace

GRAINLAW_CLONES OfSpheres step_all(const Nodes& nodes, std::span<const ForceRecord<3>> residual,
                                   double keep, double gain) {
  NodeStep<8> step(nodes, keep, gain);
  for (std::size_t q = 0; q < residual.size(); ++q) {
    step(q, load<8>(&residual[q].x));
    if (nodes.z != nullptr) renew_half(nodes.z + 8 * q);
  }
  return step.measured<OfSpheres>();
}

GRAINLAW_CLONES OfSpheres gather_and_step(const Nodes& nodes, const ContactList<3>& contacts,
                                          const NodeDrag<3>& drag, double keep, double gain) {
  NodeStep<8> step(nodes, keep, gain);
  const bool dragged = !drag.expected.empty();
  contacts.sums.for_each(contacts.forces, opposite<3>, [&](std::size_t q, const Lanes<8>& r) {
    step(q, dragged ? r + drag_on(q, nodes.z, drag) : r);
    renew_half(nodes.z + 8 * q);
  });
  return step.measured<OfSpheres>();
}

}  // namespace grainlaw::core::node_step

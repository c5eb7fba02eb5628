#include "equilibrium/node_step.hpp"

namespace grainlaw::core::node_step {

using OfDiscs = StepMeasures;

GRAINLAW_CLONES OfDiscs step_all(const Nodes& nodes, std::span<const ForceRecord<2>> residual,
                                 double keep, double gain) {
  NodeStep<4> step(nodes, keep, gain);
  for (std::size_t q = 0; q < residual.size(); ++q) step(q, load<4>(&residual[q].x));
  return step.measured<OfDiscs>();
}

GRAINLAW_CLONES OfDiscs gather_and_step(const Nodes& nodes, const ContactList<2>& contacts,
                                        const NodeDrag<2>& drag, double keep, double gain) {
  NodeStep<4> step(nodes, keep, gain);
  if (!drag.expected.empty()) {
    contacts.sums.for_each(contacts.forces, opposite<2>, [&](std::size_t q, const Lanes<4>& r) {
      step(q, r + drag_on(q, nodes.z, drag));
    });
    return step.measured<OfDiscs>();
  }
  contacts.sums.for_each(contacts.forces, opposite<2>,
                         [&](std::size_t q, const Lanes<4>& r) { step(q, r); });
  return step.measured<OfDiscs>();
}

}  // namespace grainlaw::core::node_step

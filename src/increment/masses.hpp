// Pseudo-masses of the unknowns, by which relaxation steps and what residuals are weighed with.
#pragma once

#include "contact/contact_forces.hpp"
#include "frame/average_masses.hpp"
#include "increment/motion.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

// tuned::mass_factor x the stiffness of the touching contacts, never below one contact's worth
// (mechanics of the relaxation: unit pseudo-time step).
template <int D>
class Masses {
 public:
  void begin(const Problem<D>& problem, const Motion<D>& motion);
  // Of the motion's records and for records alone: the mass of the roll R theta is I / R^2.
  ContactTotals sum(const Problem<D>& problem, const Motion<D>& motion, ContactList<D>& contacts);
  // From the records to unknowns: that of a rotation is I [N m].
  void put(const Problem<D>& problem, const Motion<D>& motion);

  // Of nodes, and behind them of the rows of F that are found.
  [[nodiscard]] std::span<const MassRecord<D>> records() const { return records_; }
  [[nodiscard]] std::span<const double> of_unknowns() const { return of_unknowns_; }
  // One contact's worth.
  [[nodiscard]] std::span<const LeastMass<D>> least() const { return least_; }
  // kn between equal particles, mean over the nodes [N/m].
  [[nodiscard]] double mean_stiffness() const;
  // Nothing is left that the average constraint carries.
  void take_out_averages(const BoundarySpace<D>& space, std::span<ForceRecord<D>> residual) const;

 private:
  void find_averages(const BoundarySpace<D>& space);
  void find_rows(const Problem<D>& problem, const Motion<D>& motion,
                 const ContactList<D>& contacts);

  std::vector<MassRecord<D>> records_;
  std::vector<double> of_unknowns_;  // component-major
  std::vector<LeastMass<D>> least_;
  std::vector<StiffnessRecord<D>> stiffness_;  // summed over the contacts of nodes
  AverageMasses averages_;
};

}  // namespace grainlaw::core

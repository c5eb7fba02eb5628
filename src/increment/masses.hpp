// Pseudo-masses of the unknowns, for relaxation steps and as weights of residuals.
#pragma once

#include "contact/contact_forces.hpp"
#include "frame/average_masses.hpp"
#include "increment/motion.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

// Masses are tuned::mass_factor x the stiffness of the touching contacts, at least that of one
// contact [N/m]. @formula relaxation
template <int D>
class Masses {
 public:
  void begin(const Problem<D>& problem, const Motion<D>& motion);
  // Sums masses from the motion's records, for records alone; rotations R theta have I / R^2.
  ContactTotals sum(const Problem<D>& problem, const Motion<D>& motion, ContactList<D>& contacts);
  // Copies masses from records to unknowns; rotations have I [N m].
  void put(const Problem<D>& problem, const Motion<D>& motion);

  // Masses of nodes, then of the rows of F that are found.
  [[nodiscard]] std::span<const MassRecord<D>> records() const { return records_; }
  [[nodiscard]] std::span<const double> of_unknowns() const { return of_unknowns_; }
  // Stiffness of one contact, per node.
  [[nodiscard]] std::span<const LeastMass<D>> least() const { return least_; }
  // Mean over the nodes of kn between equal particles [N/m].
  [[nodiscard]] double mean_stiffness() const;
  // Projects out the part of the residual that the average constraint supports.
  void project_out_averages(const BoundarySpace<D>& space,
                            std::span<ForceRecord<D>> residual) const;

 private:
  void find_averages(const BoundarySpace<D>& space);
  void find_rows(const Problem<D>& problem, const Motion<D>& motion,
                 const ContactList<D>& contacts);

  std::vector<MassRecord<D>> records_;
  std::vector<double> of_unknowns_;  // component-major
  std::vector<LeastMass<D>> least_;
  std::vector<StiffnessRecord<D>> stiffness_;  // sums over the contacts of nodes
  AverageMasses averages_;
};

}  // namespace grainlaw::core

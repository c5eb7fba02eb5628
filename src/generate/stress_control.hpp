// A periodic packing driven through equilibria to a wanted stress or void ratio.
#pragma once

#include "equilibrium/strategy.hpp"
#include "generate/stress_descent.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Newton's method on the exact tangent with F upper triangular. Each increment ends in equilibrium
// and advances the friction history. It works near the point where stiff packings lose contact,
// where compression through states out of equilibrium fails.
template <int D>
class StressControl {
 public:
  // Starts from configuration `at`.
  //   reference    packing at F = I
  //   force_floor  least force scale of residuals [N]
  StressControl(const Packing& reference, const ContactLaw& law, Configuration<D> at,
                double force_floor);

  // Drives the packing to the target within the tolerance relative to the pressure or volume.
  // Returns false when an equilibrium was not found; the last equilibrium stays.
  bool reach(const StressTarget<D>& target, double tolerance = tight);
  static constexpr double tight = 1e-7;

  [[nodiscard]] const Configuration<D>& configuration() const { return at_; }
  [[nodiscard]] const Problem<D>& problem() const { return problem_; }
  [[nodiscard]] double pressure() const;  // [Pa]
  [[nodiscard]] double volume() const;    // det F

 private:
  [[nodiscard]] Tensor<D> cauchy() const;
  [[nodiscard]] double misfit(const StressTarget<D>& target) const;
  [[nodiscard]] StressDescent<D> descent(const StressTarget<D>& target) const;
  [[nodiscard]] bool accept(const Tensor<D>& deformation, double least_pressure);

  ContactLaw law_;
  BoundarySpace<D> space_;
  Problem<D> problem_;
  SolverOptions options_;
  Workspace<D> workspace_;
  Configuration<D> at_, next_;
  Tensor4<D> tangent_{};
};

// The packing of a configuration as a new reference, with contact forces.
template <int D>
Packing packing_of(const Problem<D>& problem, const Configuration<D>& at);

}  // namespace grainlaw::core

// A periodic packing led through equilibria until its stress, or its void ratio, is the wanted one.
#pragma once

#include "equilibrium/strategy.hpp"
#include "generate/stress_descent.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Newton's method on the exact tangent with F upper triangular, in increments each of which ends in
// equilibrium and advances the friction history. It works where compression, which passes through
// states out of equilibrium, finds no packing: near the point where stiff packings come apart.
template <int D>
class StressControl {
 public:
  //   reference  packing at F = I; the configuration starts from it
  //   force_floor  of the residuals' scale [N]
  StressControl(const Packing& reference, const ContactLaw& law, Configuration<D> at,
                double force_floor);

  // To so much of the pressure, or of the volume. False when no equilibrium was found on the way; the
  // configuration is then the last one found.
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

// The packing as it stands in a configuration: its own reference from now on, with contact forces.
template <int D>
Packing packing_of(const Problem<D>& problem, const Configuration<D>& at);

}  // namespace grainlaw::core

// A periodic packing led through equilibria until its stress, or its void ratio, is the wanted one.
#pragma once

#include "equilibrium/strategy.hpp"
#include "packing/packing.hpp"

#include <array>

namespace grainlaw::core {

// Cauchy stress sigma11 = -p (1 + q), sigma22 = -p (1 - q), sigma12 = -p r.
struct StressTarget {
  double pressure = 0;               // p [Pa]; unused when volume > 0
  double volume = 0;                 // det F instead of the pressure, 0: none [-]
  std::array<double, 2> deviator{};  // q, r [-]
  bool free_shear = true;            // F12 stays, whatever sigma12
};

// Newton's method on the exact tangent with F upper triangular, in increments each of which ends in
// equilibrium and advances the friction history. It works where compression, which passes through
// states out of equilibrium, finds no packing: near the point where stiff packings come apart.
class StressControl {
 public:
  //   reference  packing at F = I; the configuration starts from it
  //   force_floor  of the residuals' scale [N]
  StressControl(const Packing& reference, const ContactLaw& law, Configuration<2> at,
                double force_floor);

  // To 1e-7 of the pressure, or of the volume. False when no equilibrium was found on the way; the
  // configuration is then the last one found.
  bool reach(const StressTarget& target);

  [[nodiscard]] const Configuration<2>& configuration() const { return at_; }
  [[nodiscard]] const Problem<2>& problem() const { return problem_; }
  [[nodiscard]] double pressure() const;  // [Pa]
  [[nodiscard]] double volume() const;    // det F

 private:
  using Tensor = grainlaw::core::Tensor<2>;

  [[nodiscard]] Tensor cauchy() const;
  [[nodiscard]] double misfit(const StressTarget& target) const;
  struct Descent;
  [[nodiscard]] Descent descent(const StressTarget& target) const;
  [[nodiscard]] bool accept(const Tensor& deformation, double least_pressure);

  ContactLaw law_;
  BoundarySpace<2> space_;
  Problem<2> problem_;
  SolverOptions options_;
  Workspace<2> workspace_;
  Configuration<2> at_, next_;
  std::array<double, 16> tangent_{};
};

// The packing as it stands in a configuration: its own reference from now on, with contact forces.
Packing packing_of(const Problem<2>& problem, const Configuration<2>& at);

}  // namespace grainlaw::core

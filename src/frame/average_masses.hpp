// Average constraints of a frame during a relaxation. The part of the residual that the constraints
// bear is projected out with the masses of the nodes.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/records.hpp"

#include <array>
#include <span>

namespace grainlaw::core {

class AverageMasses {
 public:
  void find(const BoundarySpace<2>& space, std::span<const MassRecord<2>> mass);

  // Replaces r by r - C A, with C = [sum r (x) A / m] [sum A (x) A / m]^-1.
  void take_out(const BoundarySpace<2>& space, std::span<const MassRecord<2>> mass,
                std::span<ForceRecord<2>> residual) const;

  // Projects out of velocities (component-major, with these masses; none: equal ones) what changes
  // the averages.
  static void project_out_velocity(const BoundarySpace<2>& space, std::size_t nodes,
                                   std::span<double> velocity, std::span<const double> mass = {});

 private:
  std::array<std::array<double, 3>, 2> inverse_{};  // of sum row row / m: xx, xy, yy
};

}  // namespace grainlaw::core

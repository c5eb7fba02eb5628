// Drag on the fluctuations: each part of an increment is one implicit Euler step of masses with
// drag.
//   r(z) - W (z - z*) = 0,  z* = G (x + rho u)   @formula viscous
// x: positions at the start of the part [m]. u: displacement of the fluctuations in the part before
// [m]. G: deformation of the part. W: stiffness of one contact over the duration of the part [N/m].
// Rotations likewise, without G. Rearrangements, which are jumps between equilibria, then take
// time.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/records.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Start of a part.
template <int D>
struct DragStart {
  double rate = 0;    // 1 / duration, in relaxation times of a contact [-]; 0: no drag
  double follow = 0;  // rho, the share of the last displacement that is expected again [-]
  Tensor<D> follow_by_stretch{};  // d rho / dG
  Tensor<D> stretch{};            // G - 1 as prescribed
};

template <int D>
class Drag {
 public:
  using Place = ParticleRecord<D>;

  void stop() { how_.rate = 0; }
  [[nodiscard]] bool acts() const { return how_.rate > 0; }
  [[nodiscard]] const DragStart<D>& how() const { return how_; }

  // Begins a part at the coordinates `start` under the deformation `from`. `affine` is its end
  // without fluctuations, `move` the last displacement under the deformation of the part. `least`
  // is the stiffness of one contact, per node.
  void begin(const DragStart<D>& how, const BoundarySpace<D>& space, bool rotating,
             std::span<const LeastMass<D>> least, const std::vector<double>& start,
             const Tensor<D>& from, std::span<const double> affine, std::span<const double> move);

  // Moves the expected positions of nodes with a change of the found components of F.
  void follow_deformation(const BoundarySpace<D>& space, const Tensor<D>& change);
  // Sets the present rotations as the reference of rotations.
  void restart_rotations(std::span<const Place> particles);

  // Subtracts the drag from the forces on the nodes [N].
  void subtract_from(std::span<ForceRecord<D>> forces, std::span<const Place> particles) const;
  // Adds factor x the drag's stiffness to the masses of the nodes [N/m].
  void add_to(std::span<MassRecord<D>> masses, double factor) const;

  // Drag for loops over nodes that are particles; empty without drag.
  [[nodiscard]] NodeDrag<D> of_nodes() const {
    return acts() ? NodeDrag<D>{expected_, stiffness_} : NodeDrag<D>{};
  }

  // Takes the contact forces on the nodes at the start of a part as the drag of the part before.
  void set_drag_before(std::span<const ForceRecord<D>> forces);
  // Takes the drag at the end of this part as that of the part before.
  void set_drag_before(std::span<const Place> particles);

  // Largest drag on a node [N].
  [[nodiscard]] double largest(std::span<const Place> particles) const;
  // Work of the drag on the fluctuations since the position `affine` [J]. It takes the mean of the
  // drag at both ends, since the energy of springs is a trapezoid too. An implicit step alone would
  // take the drag at its end. @formula viscous
  [[nodiscard]] double work(std::span<const Place> particles, std::span<const double> affine) const;

  // Stiffness of the drag on node q [N/m].
  [[nodiscard]] const MassRecord<D>& stiffness(std::size_t q) const { return stiffness_[q]; }
  // Distance of node q from its expected position; rotations as lengths R theta [m].
  [[nodiscard]] Place excess(std::size_t q, std::span<const Place> particles) const;
  // Last displacement of node q, which the drag expects again; rotations as lengths R theta [m].
  [[nodiscard]] const Place& move(std::size_t q) const { return move_[q]; }

  // Coordinates and F at the start of the part.
  [[nodiscard]] const std::vector<double>& start() const { return part_start_; }
  [[nodiscard]] const Tensor<D>& from() const { return from_; }

 private:
  DragStart<D> how_;
  Tensor<D> from_{};
  std::vector<double> part_start_;
  std::vector<std::int32_t> particle_;  // one particle of each node
  std::vector<Place> expected_, move_;
  std::vector<MassRecord<D>> stiffness_;
  std::vector<ForceRecord<D>> before_;  // drag at the start of the part
};

}  // namespace grainlaw::core

// Drag on the fluctuations: one implicit Euler step of masses with drag, against the move that is
// expected of them. What is a jump of an equilibrium, a rearrangement, takes time so.
//   r(z) - W (z - z*) = 0,  z* = G (x + rho u)
// with the places x where the part of an increment began, the move u of the fluctuations in the part
// before it, the deformation G of the part, and W one contact's stiffness over the duration of the
// part. Rotations likewise, of which G changes nothing.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/records.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// How a part begins.
template <int D>
struct DragStart {
  double rate = 0;    // 1 / duration, that in relaxation times of a contact [-]; 0: no drag
  double follow = 0;  // rho, how much of the last move is expected again [-]
  Tensor<D> follow_by_stretch{};  // its derivative by G
  Tensor<D> stretch{};            // G - 1 as it is asked for
};

template <int D>
class Drag {
 public:
  using Place = ParticleRecord<D>;

  void stop() { how_.rate = 0; }
  [[nodiscard]] bool acts() const { return how_.rate > 0; }
  [[nodiscard]] const DragStart<D>& how() const { return how_; }

  // Of a part that begins at the coordinates `start` under the deformation `from`. Without fluctuations
  // it would lead to `affine`; `move` is the last move under the deformation of the part. `least` is one
  // contact's stiffness, by nodes.
  void begin(const DragStart<D>& how, const BoundarySpace<D>& space, bool rotating,
             std::span<const LeastMass<D>> least, const std::vector<double>& start,
             const Tensor<D>& from, std::span<const double> affine, std::span<const double> move);

  // Of nodes, where F changes by what is found: as it moves their particles.
  void follow_deformation(const BoundarySpace<D>& space, const Tensor<D>& change);
  // Rotations are counted from where they are.
  void restart_turns(std::span<const Place> particles);

  // Take the drag from the forces on the nodes, and add its stiffness to masses of the nodes.
  void subtract_from(std::span<ForceRecord<D>> forces, std::span<const Place> particles) const;
  void add_to(std::span<MassRecord<D>> masses, double factor) const;

  // The same for loops over nodes that are particles; empty without drag.
  [[nodiscard]] NodeDrag<D> of_nodes() const {
    return acts() ? NodeDrag<D>{expected_, stiffness_} : NodeDrag<D>{};
  }

  // Forces of the contacts on the nodes where the next part begins: the drag of the part before it.
  void go_on_from(std::span<const ForceRecord<D>> forces);
  // The same where this part ended.
  void go_on_from(std::span<const Place> particles);

  // The largest drag on a node [N].
  [[nodiscard]] double largest(std::span<const Place> particles) const;
  // What it takes from where the node would be without a fluctuation, `affine`, on: by the mean of the
  // drag it begins and ends with, as stored energy is that of springs, while only the end would be an
  // implicit step's own [J].
  [[nodiscard]] double work(std::span<const Place> particles, std::span<const double> affine) const;

  // Of a node: stiffness [N/m], distance from what was expected and the move that is expected again,
  // rotations as turned lengths [m].
  [[nodiscard]] const MassRecord<D>& stiffness(std::size_t q) const { return stiffness_[q]; }
  [[nodiscard]] Place excess(std::size_t q, std::span<const Place> particles) const;
  [[nodiscard]] const Place& move(std::size_t q) const { return move_[q]; }

  // Coordinates where the part began, and F there.
  [[nodiscard]] const std::vector<double>& start() const { return part_start_; }
  [[nodiscard]] const Tensor<D>& from() const { return from_; }

 private:
  DragStart<D> how_;
  Tensor<D> from_{};
  std::vector<double> part_start_;
  std::vector<std::int32_t> particle_;  // one of each node
  std::vector<Place> expected_, move_;
  std::vector<MassRecord<D>> stiffness_;
  std::vector<ForceRecord<D>> before_;  // the drag it begins with
};

}  // namespace grainlaw::core

// What holds back the fluctuations where they take time: drag, or the inertia of the particles.
//
// Drag is by a spring, a dashpot and a mass in series. A part of an increment solves their
// equations exactly for a constant velocity of the fluctuations.
//   r(z) = f = W (z - z*),  W = k exp(-h),  z* = G (x + t u - (1 - h) f_0 / k)   @formula viscous
// x: positions at the start of the part [m]. u: velocity of the masses there [m per memory]. f_0:
// drag there [N]. G: deformation of the part. h: its duration, t: h, bounded [memories]. k:
// stiffness of the springs [N/m]. Rotations likewise, without G. Rearrangements, which are jumps
// between equilibria, then take time.
//
// Inertia is that of the particles' masses, by an implicit step of the time t with the weight
// theta.
//   r(z) = W (z - z*),  W = m / (theta t)^2,  z* = G x + t v + (1 / theta - 1) f_0 / W
// v: velocity of the fluctuations [m/s]. f_0: contact forces at the start.   @formula inertia-step
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/records.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Start of a part.
template <int D>
struct DragStart {
  double stiffness = 0;  // k of a translation [N/m]; of inertia W / m [1/s2]; 0: nothing acts
  double duration = 0;   // h, at most tuned::longest_drag [memories]; of inertia 0
  double follow = 0;  // time for which the masses are followed, h unless that is long [memories];
                      // of inertia the time step [s]
  double spring_share = 1;  // lengths of the springs by which z* is nearer
  double theta = 0;         // weight of the end of the step [-]; 0: drag
  // Derivatives by F at the end of the increment.
  Tensor<D> duration_by_F{};  // of h
  double follow_by_duration = 1;
  Tensor<D> log_stiffness_by_F{};  // of log k
  Tensor<D> strain_rate{};         // mean strain rate at the end of the increment [1 / memory]
  // Rotation of the packing, in which the motion is seen without it [rad].
  std::array<double, Dimension<D>::spins> turn{};
};

// Velocity that a mass at rest gains in a part over its displacement beyond affine motion
// [1 / memory]. Slope: derivative by the duration of the part.
struct MeanPull {
  double value = 0, slope = 0;
};
[[nodiscard]] MeanPull mean_pull(double duration);

template <int D>
class Drag {
 public:
  using Place = ParticleRecord<D>;

  void stop() { how_.stiffness = 0; }
  // True from the start of a part until its end.
  [[nodiscard]] bool in_part() const { return acts() && in_part_; }
  [[nodiscard]] bool acts() const { return how_.stiffness > 0; }
  [[nodiscard]] bool has_inertia() const { return acts() && how_.theta > 0; }
  [[nodiscard]] const DragStart<D>& how() const { return how_; }

  // Begins a part at the coordinates `start` under the deformation `from`. `affine` is its end
  // without fluctuations, `velocity` that of the masses and `stretch` the deformation of the part
  // that it underwent. Per node: `least` is the stiffness of one contact, `mass` that of inertia.
  void begin(const DragStart<D>& how, const BoundarySpace<D>& space, bool rotating,
             std::span<const LeastMass<D>> least, std::span<const MassRecord<D>> mass,
             const std::vector<double>& start, const Tensor<D>& from, const Tensor<D>& stretch,
             std::span<const double> affine, std::span<const double> velocity);

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

  // Takes the contact forces on the nodes at the start of a part as the drag there.
  void set_first_force(std::span<const ForceRecord<D>> forces);
  // Takes the drag at the end of this part as that at the start of the next.
  void set_first_force(std::span<const Place> particles);
  // Writes the velocities of the masses at the end of the part, component-major, for particles whose
  // affine motion led to `affine` by the deformation `stretch`. They keep the averages that the
  // boundary constrains.
  void find_velocity(const BoundarySpace<D>& space, std::span<const Place> particles,
                     std::span<const double> affine, const Tensor<D>& stretch,
                     std::span<double> velocity);

  // Largest drag on a node [N].
  [[nodiscard]] double largest(std::span<const Place> particles) const;
  // Work of the drag on the fluctuations since the position `affine`, and of its moments on the
  // rotation of the packing [J]. It takes the mean of the drag at both ends, since the energy of the
  // contacts is a trapezoid too. @formula viscous
  [[nodiscard]] double work(std::span<const Place> particles, std::span<const double> affine) const;

  // Stiffness of the drag on node q [N/m].
  [[nodiscard]] const MassRecord<D>& stiffness(std::size_t q) const { return stiffness_[q]; }
  // Stiffness k of the spring of node q, component c [N/m].
  [[nodiscard]] double spring_stiffness(std::size_t q, std::size_t c) const {
    return std::exp(how_.duration) * component(stiffness_[q], c);
  }
  // Distance of node q from its expected position; rotations as lengths R theta [m].
  [[nodiscard]] Place excess(std::size_t q, std::span<const Place> particles) const;
  // Distance of node q from its expected position that F carries along: all of it, but with inertia
  // that from affine motion [m].
  [[nodiscard]] Place carried_excess(std::size_t q, std::span<const Place> particles) const;
  // Velocity of the mass of node q at the start of the part; rotations as lengths [m per memory;
  // with inertia m/s].
  [[nodiscard]] const Place& velocity(std::size_t q) const { return velocity_[q]; }
  // Length of the spring of node q at the start of the part, f_0 / k [m].
  [[nodiscard]] const Place& spring(std::size_t q) const { return spring_[q]; }

  // With inertia: velocity of node q at the end of the part, component k [m/s]. It is found from
  // the free velocity, before F acts on it. @formula inertia-velocity
  [[nodiscard]] double end_velocity(std::size_t q, std::size_t k) const {
    return node_velocity_[k * expected_.size() + q];
  }
  [[nodiscard]] Place free_velocity(std::size_t q, std::span<const Place> particles) const;
  // Derivative of the free velocity by the distance from the expected position [1/s].
  [[nodiscard]] double velocity_by_excess() const {
    return how_.theta * how_.follow * how_.stiffness;
  }
  // With inertia: what rounding of coordinates makes of its forces [N]. Those of short steps are
  // small differences of large numbers.
  [[nodiscard]] double rounding() const { return rounding_; }
  // With inertia: mass of node q [kg].
  [[nodiscard]] double mass(std::size_t q) const { return stiffness_[q].x / how_.stiffness; }

  // Coordinates and F at the start of the part.
  [[nodiscard]] const std::vector<double>& start() const { return part_start_; }
  [[nodiscard]] const Tensor<D>& from() const { return from_; }

 private:
  void find_mass_velocity(std::span<const Place> particles, std::span<const double> affine);
  void find_particle_velocity(const BoundarySpace<D>& space, std::span<const Place> particles,
                              const Tensor<D>& stretch);

  DragStart<D> how_;
  Tensor<D> from_{};
  std::vector<double> part_start_;
  std::vector<std::int32_t> particle_;  // one particle of each node
  std::vector<Place> expected_, velocity_, spring_;
  std::vector<MassRecord<D>> stiffness_;
  std::vector<ForceRecord<D>> first_;  // drag at the start of the part
  std::vector<double> node_velocity_;
  double rounding_ = 0;
  bool in_part_ = false;
};

}  // namespace grainlaw::core

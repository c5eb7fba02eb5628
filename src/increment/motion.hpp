// Where the particles are on the way of an increment: F, their coordinates, and where the history of
// contacts starts.
#pragma once

#include "contact/records.hpp"
#include "increment/configuration.hpp"
#include "increment/drag.hpp"
#include "increment/problem.hpp"
#include "increment/turns.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Coordinates are component-major: positions [m], and rotations since the increment began. The same as
// records is what loops over contacts read: who moves the one loads or stores the other.
template <int D>
class Motion {
 public:
  // At rest where `from` is; the history starts there.
  void begin(const Problem<D>& problem, const Configuration<D>& from);
  // To another F: affinely, and what is prescribed to its place.
  void deform(const Tensor<D>& target);
  // Every particle by factor x its node's step (component-major over nodes), and found components of F.
  void move(std::span<const double> step, double factor = 1);
  // To where it was, or may be.
  void go_to(std::span<const double> coordinates, const Tensor<D>& deformation);
  [[nodiscard]] double& coordinate(std::size_t component, std::size_t particle) {
    return coordinates_[component * problem_->particles() + particle];
  }

  void load_records();
  void store_records();
  [[nodiscard]] std::span<ParticleRecord<D>> records() { return records_; }
  [[nodiscard]] std::span<const ParticleRecord<D>> records() const { return records_; }
  // Change F by a record for every row, times scale(), and the records of particles with it.
  void change_deformation(const double* rows);

  // The history starts here; or it does but for nodes that nothing holds (fixed_bit() of each direction):
  // they start where F carries their last start, and the mean fluctuation of those that are held.
  void start_here();
  void start_here(std::span<const unsigned char> held);
  // Spheres count their rotations from here.
  void restart_turns();

  // Forces of the contacts on the nodes where the increment begins, which drag held there.
  void find_first_drag(std::span<const ForceRecord<D>> forces) { drag_.go_on_from(forces); }
  // From the start of the history to the present F fluctuations meet a drag, after a part in which they
  // moved by `last_move` (coordinates; empty: not at all); `contact_stiffness` is one contact's, by nodes.
  // Where `as_expected`, particles go where the drag expects them.
  void begin_drag(const DragStart<D>& how, std::span<const LeastMass<D>> contact_stiffness,
                  std::span<const double> last_move, bool as_expected);
  // Where the part ends: the move of the fluctuations goes to `move`; returns what the drag took [J].
  double end_drag(std::vector<double>& move);
  [[nodiscard]] const Drag<D>& drag() const { return drag_; }

  // Without what has moved as a whole; rotations added to those of `from`.
  void export_to(const Configuration<D>& from, Configuration<D>& to) const;

  [[nodiscard]] const std::vector<double>& coordinates() const { return coordinates_; }
  [[nodiscard]] const Tensor<D>& deformation() const { return deformation_; }
  [[nodiscard]] const Tensor<D>& cell() const { return cell_; }  // F H0, zero on a frame [m]
  [[nodiscard]] std::span<const double> start() const { return start_; }
  [[nodiscard]] const Tensor<D>& start_deformation() const { return start_deformation_; }
  [[nodiscard]] Tensor<D> start_cell() const { return cell_at(start_deformation_); }
  // Where the increment began.
  [[nodiscard]] const Tensor<D>& committed_deformation() const { return committed_deformation_; }

  // Components of F that are found count as lengths: F times this [m], so that their residual is a
  // force, the missing stress on the cross section of one particle.
  [[nodiscard]] double deformation_scale() const { return deformation_scale_; }
  [[nodiscard]] double mean_branch() const { return mean_branch_; }                   // 2 R [m]
  [[nodiscard]] std::span<const double> node_radius() const { return node_radius_; }  // [m]
  // Reference branch for a space bound to axes: X'_j - X'_i [m].
  [[nodiscard]] Vec<D> fixed_branch(std::int32_t i, std::int32_t j) const;

 private:
  static constexpr std::size_t dim = D;

  [[nodiscard]] Tensor<D> cell_at(const Tensor<D>& f) const;
  void carry_affinely(const Tensor<D>& from, const Tensor<D>& to, double* positions) const;
  [[nodiscard]] double affine_place(std::size_t p, std::size_t direction) const;
  void place_fixed();
  // How far a packing that nothing holds has moved as a whole [m].
  [[nodiscard]] Vec<D> drift() const;

  const Problem<D>* problem_ = nullptr;
  Tensor<D> deformation_{};  // free of the increment's rotation
  Tensor<D> start_deformation_{};
  Tensor<D> committed_deformation_{};
  Tensor<D> cell_{};
  std::vector<double> coordinates_;
  std::vector<double> start_;  // coordinates where the history starts
  std::vector<ParticleRecord<D>> records_;
  Turned<D> turned_;
  std::vector<double> carried_start_;
  Drag<D> drag_;
  std::vector<double> affine_, last_move_;
  std::vector<double> node_radius_;
  double deformation_scale_ = 1;
  double mean_branch_ = 0;
};

}  // namespace grainlaw::core

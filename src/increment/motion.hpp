// Motion of the particles in an increment: F, coordinates, and the start of the contact history.
#pragma once

#include "contact/records.hpp"
#include "increment/configuration.hpp"
#include "increment/drag.hpp"
#include "increment/problem.hpp"
#include "increment/rotations.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Coordinates are component-major: positions [m], then rotations since the increment began. Loops
// over contacts read records of them; code that changes the one loads or stores the other.
template <int D>
class Motion {
 public:
  // Begins at rest in configuration `from`, where the history starts.
  void begin(const Problem<D>& problem, const Configuration<D>& from);
  // Moves particles affinely to another F, and prescribed ones to their positions.
  void deform(const Tensor<D>& target);
  // Adds factor x the step of its node (component-major) to every particle, and to found components
  // of F.
  void move(std::span<const double> step, double factor = 1);
  // Sets coordinates and F.
  void go_to(std::span<const double> coordinates, const Tensor<D>& deformation);
  [[nodiscard]] double& coordinate(std::size_t component, std::size_t particle) {
    return coordinates_[component * problem_->particles() + particle];
  }

  void load_records();
  void store_records();
  [[nodiscard]] std::span<ParticleRecord<D>> records() { return records_; }
  [[nodiscard]] std::span<const ParticleRecord<D>> records() const { return records_; }
  // Adds rows, scaled by deformation_scale(), to F and moves the particles' records with it.
  void change_deformation(const double* rows);

  // Starts the history here.
  void start_here();
  // Starts the history here for supported nodes (fixed_bit() of each direction). Others start at
  // the affine image of their last start, plus the mean fluctuation of the supported ones.
  void start_here(std::span<const unsigned char> supported);
  // Sets the present rotations of spheres as the reference.
  void restart_rotations();

  // Takes contact forces on the nodes at the start of the increment as the drag there.
  void set_first_drag(std::span<const ForceRecord<D>> forces) { drag_.set_first_force(forces); }
  // Begins drag or inertia from the start of the history to the present F. `velocity` is that of
  // its masses there (empty: 0). `contact_stiffness` is that of one contact, per node. With
  // `as_expected`, particles go on as the masses move.
  void begin_drag(const DragStart<D>& how, std::span<const LeastMass<D>> contact_stiffness,
                  std::span<const double> velocity, bool as_expected);
  // Ends the part: writes the velocity of the masses and returns the work of the drag [J].
  double end_drag(std::vector<double>& velocity);
  // Work of the drag since its part began; 0 between parts [J].
  [[nodiscard]] double work_of_drag();
  [[nodiscard]] const Drag<D>& drag() const { return drag_; }
  // Deformation since drag began, as positions follow it.
  [[nodiscard]] Tensor<D> part_deformation() const {
    if (problem_->space->bound_to_axes()) return identity<D>();
    return product<D>(deformation_, inverse<D>(drag_.from()));
  }

  // Largest distance of a particle from its affine image since `from`, but for rigid translation [m].
  [[nodiscard]] double largest_fluctuation(const Configuration<D>& from);

  // Writes coordinates without rigid translation, with rotations since F = I.
  void export_to(const Configuration<D>& from, Configuration<D>& to) const;

  [[nodiscard]] const std::vector<double>& coordinates() const { return coordinates_; }
  [[nodiscard]] const Tensor<D>& deformation() const { return deformation_; }
  [[nodiscard]] const Tensor<D>& cell() const { return cell_; }  // F H0, zero on a frame [m]
  [[nodiscard]] std::span<const double> start() const { return start_; }
  [[nodiscard]] const Tensor<D>& start_deformation() const { return start_deformation_; }
  [[nodiscard]] Tensor<D> start_cell() const { return cell_at(start_deformation_); }
  // F at the start of the increment.
  [[nodiscard]] const Tensor<D>& committed_deformation() const { return committed_deformation_; }

  // Length by which found components of F are scaled [m]. Their residual is then a force: the
  // missing stress on the cross section of one particle.
  [[nodiscard]] double deformation_scale() const { return deformation_scale_; }
  [[nodiscard]] double mean_branch() const { return mean_branch_; }                   // 2 R [m]
  [[nodiscard]] std::span<const double> node_radius() const { return node_radius_; }  // [m]
  // Reference branch X'_j - X'_i for a space bound to axes [m].
  [[nodiscard]] Vec<D> fixed_branch(std::int32_t i, std::int32_t j) const;

 private:
  static constexpr std::size_t dim = D;

  [[nodiscard]] Tensor<D> cell_at(const Tensor<D>& f) const;
  void carry_affinely(const Tensor<D>& from, const Tensor<D>& to, double* positions) const;
  [[nodiscard]] double affine_position(std::size_t p, std::size_t direction) const;
  void correct_rounding();
  // Rigid translation of a packing without fixed particles [m].
  [[nodiscard]] Vec<D> drift() const;

  const Problem<D>* problem_ = nullptr;
  Tensor<D> deformation_{};  // without the increment's rotation
  Tensor<D> start_deformation_{};
  Tensor<D> committed_deformation_{};
  Tensor<D> cell_{};
  std::vector<double> coordinates_;
  std::vector<double> start_;  // coordinates at the start of the history
  std::vector<ParticleRecord<D>> records_;
  RotationReference<D> turned_;
  std::vector<double> carried_;
  Drag<D> drag_;
  std::vector<double> affine_, velocity_;
  std::vector<MassRecord<D>> masses_;  // of the particles, with inertia
  std::vector<double> node_radius_;
  double deformation_scale_ = 1;
  double mean_branch_ = 0;
};

}  // namespace grainlaw::core

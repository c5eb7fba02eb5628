// Balance of forces at the present coordinates: from motion and contacts to forces, masses and the
// residual. It owns the memory that the solvers share; buffers are sized once.
#pragma once

#include "contact/half_contacts.hpp"
#include "increment/force_scale.hpp"
#include "increment/losses.hpp"
#include "increment/masses.hpp"
#include "increment/motion.hpp"
#include "increment/two_contact_spheres.hpp"

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

namespace grainlaw::core {

// Reference of friction: the start of the increment, or the last evaluation.
enum class History { committed, advancing };

// Solvers change the motion; the functions here derive forces and masses from it.
template <int D>
class ForceBalance {
 public:
  // Computes forces at the present coordinates, and the residual.
  void update_forces(History history = History::committed);
  // Computes reduced forces on nodes from the present records, without the residual.
  void find_forces(History history);
  // Computes the forces of the contacts from the present records.
  void find_contact_forces();
  // Computes forces on nodes, drag included, before reduction.
  void sum_forces(std::span<ForceRecord<D>> forces);

  // Adds the springs of two-contact spheres to the residual from the next update_forces() on.
  // Returns whether the law needs them.
  bool add_chord_springs();
  void remove_chord_springs() { has_chord_springs_ = false; }
  // Finds the two-contact spheres at the present coordinates. Returns the largest force of their
  // springs over the force scale [-].
  double find_two_contact_spheres();
  [[nodiscard]] const auto& two_contact_spheres() const { return two_contact_spheres_; }

  // Updates masses and force scale at the present coordinates.
  void refresh_masses();
  // Updates masses and force scale from the present records, for the records alone.
  void sum_masses();
  // Relinearises half contacts around the present records and updates the force scale; they have
  // masses of their own.
  void relinearise(HalfContacts<D>& half_contacts);

  // True if contacts or inertia hold particles.
  [[nodiscard]] bool held() const { return scale_.touching() > 0 || problem_->inertia; }

  // Largest residual force (moment / R) of update_forces over the force scale [-]. Infinite where
  // nothing holds the particles or if a number is not finite.
  [[nodiscard]] double residual_norm() const;

  [[nodiscard]] const Problem<D>& problem() const { return *problem_; }
  [[nodiscard]] Motion<D>& motion() { return motion_; }
  [[nodiscard]] const Motion<D>& motion() const { return motion_; }
  [[nodiscard]] const ContactList<D>& contacts() const { return contacts_; }
  [[nodiscard]] const Masses<D>& masses() const { return masses_; }
  [[nodiscard]] const ForceScale& scale() const { return scale_; }
  // Forces on nodes [N], then on the rows of F where components are found.
  [[nodiscard]] std::span<const ForceRecord<D>> forces() const { return forces_; }
  // Residual of the unknowns, component-major [N, N m].
  [[nodiscard]] std::span<const double> residual() const { return residual_; }

 protected:
  // Prepares all but the contacts for a configuration.
  void begin(const Problem<D>& problem, const Configuration<D>& from);
  void reduce(std::span<ForceRecord<D>> forces) const;

  const Problem<D>* problem_ = nullptr;
  Motion<D> motion_;
  ContactList<D> contacts_;
  Masses<D> masses_;
  ForceScale scale_;
  Losses losses_;
  std::vector<ForceRecord<D>> forces_;

 private:
  static constexpr std::size_t dim = D;
  static constexpr std::size_t spins = Dimension<D>::spins;

  void add_missing_stress(std::span<ForceRecord<D>> forces) const;

  std::vector<double> residual_;
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<D == 3, TwoContactSpheres, Nothing> two_contact_spheres_;
  bool has_chord_springs_ = false;
};

}  // namespace grainlaw::core

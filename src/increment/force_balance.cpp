#include "increment/force_balance.hpp"

#include "base/constants.hpp"
#include "contact/contact_forces.hpp"
#include "increment/mass_factor.hpp"
#include "increment/records.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

template <int D>
void ForceBalance<D>::begin(const Problem<D>& problem, const Configuration<D>& from) {
  problem_ = &problem;
  has_chord_springs_ = false;
  losses_.begin();
  motion_.begin(problem, from);
  masses_.begin(problem, motion_);
  scale_.begin(problem, motion_);
  forces_.resize(problem.nodes() + problem.rows());
  residual_.resize(problem.unknowns());
}

template <int D>
void ForceBalance<D>::refresh_masses() {
  motion_.load_records();
  sum_masses();
  masses_.put(*problem_, motion_);
}

template <int D>
void ForceBalance<D>::sum_masses() {
  scale_.take(masses_.sum(*problem_, motion_, contacts_));
}

template <int D>
void ForceBalance<D>::relinearise(HalfContacts<D>& half_contacts) {
  const ContactLaw& law = *problem_->law;
  scale_.take(half_contacts.relinearise(motion_.records(), law, mass_factor(law), contacts_));
  if (motion_.drag().acts()) {
    half_contacts.add_drag(motion_.records(), motion_.drag().of_nodes(), tuned::mass_factor);
  }
}

template <int D>
void ForceBalance<D>::update_forces(History history) {
  motion_.load_records();
  find_forces(history);
  put_residual(forces_.data(), motion_.node_radius(), problem_->law->rotating(), residual_.data());
  double* of_rows = residual_.data() + problem_->node_unknowns();
  for (std::size_t i = 0; i < problem_->rows(); ++i) {
    std::copy_n(&forces_[problem_->nodes() + i].x, dim, of_rows + dim * i);
  }
  if constexpr (D == 3) {
    if (!has_chord_springs_) return;
    two_contact_spheres_.find(*this);
    two_contact_spheres_.add_to(problem_->nodes(), residual_);
  }
}

template <int D>
bool ForceBalance<D>::add_chord_springs() {
  if constexpr (D == 3) has_chord_springs_ = TwoContactSpheres::possible(*this);
  return has_chord_springs_;
}

template <int D>
double ForceBalance<D>::find_two_contact_spheres() {
  if constexpr (D == 2) return 0;
  if constexpr (D == 3) {
    two_contact_spheres_.forget();
    if (!TwoContactSpheres::possible(*this)) return 0;
    refresh_masses();
    two_contact_spheres_.find(*this);
    double largest = 0;
    for (const auto& sphere : two_contact_spheres_.spheres()) {
      largest = std::max(largest, sphere.force(motion_.node_radius()[sphere.node]));
    }
    return largest / scale_.relative();
  }
}

template <int D>
void ForceBalance<D>::find_forces(History history) {
  if (history == History::advancing) {
    losses_.dissipate(advance_contacts<D>(motion_.records(), *problem_->law, contacts_, forces_));
    motion_.restart_rotations();
  } else {
    sum_forces(forces_);
  }
  reduce(forces_);
}

template <int D>
void ForceBalance<D>::find_contact_forces() {
  core::find_contact_forces<D>(motion_.records(), *problem_->law, contacts_);
}

template <int D>
void ForceBalance<D>::sum_forces(std::span<ForceRecord<D>> forces) {
  evaluate_contacts<D>(motion_.records(), *problem_->law, contacts_, forces);
  if (motion_.drag().acts()) motion_.drag().subtract_from(forces, motion_.records());
}

// Reduces forces on nodes to residuals. Prescribed components become 0, and the part that the
// average constraint supports is projected out, with the present masses. Found rows of F get the
// missing stress as forces.
template <int D>
void ForceBalance<D>::reduce(std::span<ForceRecord<D>> forces) const {
  const auto& space = *problem_->space;
  if (space.identity) return;
  for (std::size_t q = 0; q < problem_->nodes(); ++q) {
    const unsigned char fixed = space.fixed[q];
    if (fixed == 0) continue;
    for (std::size_t k = 0; k < Dimension<D>::unknowns; ++k) {
      if ((fixed & fixed_bit(k)) != 0) component(forces[q], k) = 0;
    }
  }
  masses_.project_out_averages(space, forces);
  if (space.finds_deformation) add_missing_stress(forces);
}

// Force on the rows of F: V (P* - P) over the scale, with V P = - sum f (x) L. @formula stress
template <int D>
void ForceBalance<D>::add_missing_stress(std::span<ForceRecord<D>> forces) const {
  const auto& space = *problem_->space;
  Tensor<D> force{};
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const double* f = &contacts_.forces[c].x;
    if (std::all_of(f, f + dim, [](double component) { return component == 0; })) continue;
    const auto branch = motion_.fixed_branch(contacts_.i[c], contacts_.j[c]);
    for (std::size_t k = 0; k < squared<D>; ++k) force[k] += f[k / dim] * branch[k % dim];
  }
  for (std::size_t k = 0; k < squared<D>; ++k) {
    force[k] = space.found[k] ? (force[k] + space.reference_volume * space.stress[k]) /
                                    motion_.deformation_scale()
                              : 0;
  }
  for (std::size_t i = 0; i < dim; ++i) {
    ForceRecord<D>& row = forces[problem_->nodes() + i];
    row = {};
    std::copy_n(force.data() + dim * i, dim, &row.x);
  }
}

template <int D>
double ForceBalance<D>::residual_norm() const {
  if (!held()) return std::numeric_limits<double>::infinity();
  const auto m = problem_->nodes();
  const double* r = residual_.data();
  double largest = 0;
  double sum = 0;  // catches NaN, which max does not
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::size_t q = 0; q < dim * m; ++q) {
    largest = std::max(largest, std::abs(r[q]));
    sum += r[q];
  }
  if (problem_->law->rotating()) {
    const double* moment = r + dim * m;
    const double* radius = motion_.node_radius().data();
    for (std::size_t k = 0; k < spins; ++k, moment += m) {
#pragma omp simd reduction(max : largest) reduction(+ : sum)
      for (std::size_t q = 0; q < m; ++q) {
        const double force = moment[q] / radius[q];
        largest = std::max(largest, std::abs(force));
        sum += force;
      }
    }
  }
  if (problem_->space->finds_deformation) {
    for (std::size_t k = problem_->node_unknowns(); k < problem_->unknowns(); ++k) {
      largest = std::max(largest, std::abs(r[k]));
      sum += r[k];
    }
    if (!(determinant<D>(motion_.deformation()) > 0)) {
      return std::numeric_limits<double>::infinity();
    }
  }
  if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  return largest / scale_.relative();
}

template class ForceBalance<2>;
template class ForceBalance<3>;

}  // namespace grainlaw::core

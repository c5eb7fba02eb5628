// Drag and inertia on the motion of a packing.
#include "base/capacity.hpp"
#include "increment/motion.hpp"
#include "increment/particle_masses.hpp"
#include "packing/geometry.hpp"

namespace grainlaw::core {

template <int D>
void Motion<D>::begin_drag(const DragStart<D>& how, std::span<const LeastMass<D>> contact_stiffness,
                           std::span<const double> velocity, bool as_expected) {
  copy_with_capacity(start_, affine_);
  carry_affinely(start_deformation_, deformation_, affine_.data());
  velocity_.assign(velocity.begin(), velocity.end());
  Tensor<D> stretch = identity<D>();
  if (how.theta > 0) {
    find_particle_masses(*problem_->packing, *problem_->space, masses_);
  } else if (!problem_->space->bound_to_axes()) {
    stretch = product<D>(deformation_, inverse<D>(start_deformation_));
    if (!velocity.empty()) map_positions<D>(stretch, problem_->particles(), velocity_.data());
  }
  drag_.begin(how, *problem_->space, problem_->law->rotating(), contact_stiffness, masses_, start_,
              start_deformation_, stretch, affine_, velocity_);
  if (!as_expected) return;
  coordinates_ = affine_;
  // Particles do not fly on through a step that is too long for what stops them.
  const double flight = how.theta > 0 ? 2 * (1 - how.theta) * how.follow : how.follow;
  for (std::size_t k = 0; k < velocity_.size(); ++k) coordinates_[k] += flight * velocity_[k];
}

template <int D>
double Motion<D>::work_of_drag() {
  if (!drag_.in_part()) return 0;
  copy_with_capacity(drag_.start(), affine_);
  carry_affinely(drag_.from(), deformation_, affine_.data());
  load_records();
  return drag_.work(records_, affine_);
}

template <int D>
double Motion<D>::end_drag(std::vector<double>& velocity) {
  const double work = work_of_drag();
  resize_with_capacity(velocity, coordinates_.size());
  drag_.find_velocity(*problem_->space, records_, affine_, part_deformation(), velocity);
  drag_.set_first_force(records_);
  return work;
}

#define GRAINLAW_FOR(D)                                                                   \
  template void Motion<D>::begin_drag(const DragStart<D>&, std::span<const LeastMass<D>>, \
                                      std::span<const double>, bool);                     \
  template double Motion<D>::work_of_drag();                                              \
  template double Motion<D>::end_drag(std::vector<double>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

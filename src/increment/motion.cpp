#include "increment/motion.hpp"

#include "base/capacity.hpp"
#include "increment/records.hpp"
#include "packing/geometry.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

// Adds the affine displacement of reference positions to x.
template <int D>
void carry_with(const double* reference, const Tensor<D>& change, std::size_t n, double* x) {
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t k = 0; k < D; ++k) {
      x[k * n + p] += dot<D>(change.data() + D * k, reference + p, n);
    }
  }
}

}  // namespace

template <int D>
Tensor<D> Motion<D>::cell_at(const Tensor<D>& f) const {
  if (problem_->packing->frame) return {};
  return product<D>(f, tensor_of<D>(problem_->packing->cell));
}

template <int D>
void Motion<D>::begin(const Problem<D>& problem, const Configuration<D>& from) {
  problem_ = &problem;
  const auto& packing = *problem.packing;
  const auto n = problem.particles();
  start_.resize(n * static_cast<std::size_t>(problem.components()));
  std::copy_n(from.coordinates.begin(), dim * n, start_.begin());
  std::fill(start_.begin() + static_cast<std::ptrdiff_t>(dim * n), start_.end(), 0.0);
  start_deformation_ = committed_deformation_ = from.deformation;
  turned_.reset(n, problem.law->rotating());
  drag_.stop();
  coordinates_ = start_;
  deformation_ = start_deformation_;
  cell_ = cell_at(deformation_);
  records_.resize(n);
  node_radius_.resize(problem.nodes());
  for (std::size_t p = 0; p < n; ++p) {
    records_[p] = {};
    records_[p].radius = packing.radius[p];
    node_radius_[static_cast<std::size_t>(problem.space->node[p])] = packing.radius[p];
  }
  mean_branch_ = 2 * mean_radius(packing.radius);
  deformation_scale_ = problem.space->reference_volume / (packing.thickness * mean_branch_);
}

template <int D>
void Motion<D>::deform(const Tensor<D>& target) {
  const auto& space = *problem_->space;
  auto to = target;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) to[k] = deformation_[k];  // until it is found
  }
  carry_affinely(deformation_, to, coordinates_.data());
  deformation_ = to;
  if (!space.bound_to_axes()) cell_ = cell_at(deformation_);
  if (!space.identity) correct_rounding();
}

// Moves positions affinely from one F to another. In a space bound to axes, fluctuations keep their
// components.
template <int D>
void Motion<D>::carry_affinely(const Tensor<D>& from, const Tensor<D>& to,
                               double* positions) const {
  const auto n = problem_->particles();
  if (problem_->space->bound_to_axes()) {
    Tensor<D> change{};
    for (std::size_t k = 0; k < squared<D>; ++k) change[k] = to[k] - from[k];
    carry_with<D>(problem_->space->reference.data(), change, n, positions);
    return;
  }
  map_positions<D>(product<D>(to, inverse<D>(from)), n, positions);
}

// Position of a particle without fluctuation.
template <int D>
double Motion<D>::affine_position(std::size_t p, std::size_t direction) const {
  const auto& space = *problem_->space;
  const bool bound = space.bound_to_axes();
  const double* x = bound ? space.reference.data() : problem_->packing->position.data();
  const auto n = problem_->particles();
  const double offset = bound ? space.offset[direction * n + p] : 0;
  return dot<D>(deformation_.data() + dim * direction, x + p, n) + offset;
}

template <int D>
Vec<D> Motion<D>::drift() const {
  Vec<D> result{};
  for (std::size_t k = 0; k < dim; ++k) {
    const int anchor = problem_->space->anchor[k];
    if (anchor < 0) continue;
    const auto p = static_cast<std::size_t>(anchor);
    result[k] = coordinates_[k * problem_->particles() + p] - affine_position(p, k);
  }
  return result;
}

// Corrects rounding that would add up over increments: prescribed particles go where F maps them,
// and rigid translation is removed.
template <int D>
void Motion<D>::correct_rounding() {
  const auto& space = *problem_->space;
  const auto n = problem_->particles();
  const auto moved = drift();
  for (std::size_t k = 0; k < dim; ++k) {
    double* x = coordinates_.data() + k * n;
    for (std::size_t p = 0; p < n; ++p) {
      const bool fixed = (space.fixed[static_cast<std::size_t>(space.node[p])] & fixed_bit(k)) != 0;
      x[p] = fixed ? affine_position(p, k) : x[p] - moved[k];
    }
  }
}

template <int D>
void Motion<D>::move(std::span<const double> step, double factor) {
  const auto& space = *problem_->space;
  const auto n = problem_->particles();
  const auto m = problem_->nodes();
  for (std::size_t k = 0; k < dim; ++k) {
    const double* dz = step.data() + k * m;
    double* z = coordinates_.data() + k * n;
    for (std::size_t p = 0; p < n; ++p) z[p] += factor * dz[space.node[p]];
  }
  if (problem_->law->rotating()) {
    add_spins<D>(step.data() + dim * m, m, space.node, factor, coordinates_.data() + dim * n);
  }
  if (!space.finds_deformation) return;
  const double* found = step.data() + problem_->node_unknowns();
  Tensor<D> change{};
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) change[k] = factor * found[k] / deformation_scale_;
    deformation_[k] += change[k];
  }
  carry_with<D>(space.reference.data(), change, n, coordinates_.data());
  if (drag_.acts()) drag_.follow_deformation(space, change);
}

template <int D>
void Motion<D>::go_to(std::span<const double> coordinates, const Tensor<D>& deformation) {
  std::copy(coordinates.begin(), coordinates.end(), coordinates_.begin());
  deformation_ = deformation;
}

template <int D>
void Motion<D>::load_records() {
  grainlaw::core::load_records(coordinates_.data(), problem_->law->rotating(), std::span(records_));
}

template <int D>
void Motion<D>::store_records() {
  grainlaw::core::store_records(std::span<const ParticleRecord<D>>(records_),
                                problem_->law->rotating(), coordinates_.data());
}

template <int D>
void Motion<D>::change_deformation(const double* rows) {
  const auto& space = *problem_->space;
  const auto n = problem_->particles();
  constexpr std::size_t lanes = Dimension<D>::lanes;
  Tensor<D> change{};
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) change[k] = rows[lanes * (k / dim) + k % dim] / deformation_scale_;
    deformation_[k] += change[k];
  }
  const double* x = space.reference.data();
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t k = 0; k < dim; ++k) {
      component(records_[p], k) += dot<D>(change.data() + dim * k, x + p, n);
    }
  }
  if (drag_.acts()) drag_.follow_deformation(space, change);
}

template <int D>
void Motion<D>::start_here() {
  start_ = coordinates_;
  start_deformation_ = deformation_;
}

// Rotations stay: the history of a particle does not depend on its orientation.
template <int D>
void Motion<D>::start_here(std::span<const unsigned char> supported) {
  const auto n = problem_->particles();
  const auto& node = problem_->space->node;
  carried_.assign(start_.begin(), start_.begin() + static_cast<std::ptrdiff_t>(dim * n));
  carry_affinely(start_deformation_, deformation_, carried_.data());
  start_here();
  for (std::size_t k = 0; k < dim; ++k) {
    const double* carried = carried_.data() + k * n;
    const auto is_supported = [&](std::size_t p) {
      return (supported[static_cast<std::size_t>(node[p])] & fixed_bit(k)) != 0;
    };
    double sum = 0;
    double count = 0;
    for (std::size_t p = 0; p < n; ++p) {
      if (!is_supported(p)) continue;
      sum += coordinates_[k * n + p] - carried[p];
      ++count;
    }
    if (count == static_cast<double>(n)) continue;
    const double mean = count > 0 ? sum / count : 0;
    for (std::size_t p = 0; p < n; ++p) {
      if (!is_supported(p)) start_[k * n + p] = carried[p] + mean;
    }
  }
}

template <int D>
double Motion<D>::largest_fluctuation(const Configuration<D>& from) {
  const auto n = problem_->particles();
  carried_.assign(from.coordinates.begin(),
                  from.coordinates.begin() + static_cast<std::ptrdiff_t>(dim * n));
  carry_affinely(from.deformation, deformation_, carried_.data());
  const auto moved = drift();
  double largest = 0;
  for (std::size_t k = 0; k < dim; ++k) {
    for (std::size_t p = k * n; p < (k + 1) * n; ++p) {
      largest = std::max(largest, std::abs(coordinates_[p] - carried_[p] - moved[k]));
    }
  }
  return largest;
}

template <int D>
void Motion<D>::restart_rotations() {
  if (!problem_->law->rotating()) return;
  if (drag_.acts()) drag_.restart_rotations(records_);
  turned_.restart(records_, coordinates_.data() + dim * problem_->particles());
}

template <int D>
Vec<D> Motion<D>::fixed_branch(std::int32_t i, std::int32_t j) const {
  const auto n = problem_->particles();
  Vec<D> result{};
  for (std::size_t k = 0; k < dim; ++k) {
    const double* x = problem_->space->reference.data() + k * n;
    result[k] = x[j] - x[i];
  }
  return result;
}

template <int D>
void Motion<D>::export_to(const Configuration<D>& from, Configuration<D>& to) const {
  const auto n = problem_->particles();
  to.deformation = deformation_;
  to.coordinates = coordinates_;
  const auto moved = drift();
  for (std::size_t k = 0; k < dim; ++k) {
    if (problem_->space->anchor[k] < 0) continue;
    for (std::size_t p = 0; p < n; ++p) to.coordinates[k * n + p] -= moved[k];
  }
  turned_.export_to(n, from.coordinates, to.coordinates);
}

template class Motion<2>;
template class Motion<3>;

}  // namespace grainlaw::core

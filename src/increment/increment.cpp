#include "increment/increment.hpp"

#include "base/constants.hpp"
#include "base/room.hpp"
#include "contact/contact_forces.hpp"
#include "increment/records.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

// Affine motion of reference positions, added to x.
template <int D>
void move_with(const double* reference, const Tensor<D>& change, std::size_t n, double* x) {
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t k = 0; k < D; ++k) {
      x[k * n + p] += dot<D>(change.data() + D * k, reference + p, n);
    }
  }
}

}  // namespace

template <int D>
Tensor<D> Increment<D>::cell_at(const Tensor<D>& f) const {
  if (problem->packing->frame) return {};
  return product<D>(f, tensor_of<D>(problem->packing->cell));
}

template <int D>
void Increment<D>::begin(const Problem<D>& p, const Configuration<D>& from,
                         const Tensor<D>& target) {
  problem = &p;
  const auto n = particles();
  const auto components = static_cast<std::size_t>(p.components());
  start.resize(n * components);
  std::copy_n(from.coordinates.begin(), dim * n, start.begin());
  std::fill(start.begin() + static_cast<std::ptrdiff_t>(dim * n), start.end(), 0.0);
  start_deformation = committed_deformation = from.deformation;
  turned_.reset(n, p.law->rotating());
  copy_with_room(from.contacts, history);
  copy_with_room(from.moments, history_moments);
  copy_with_room(from.bond_gaps, history_gaps);
  coordinates = start;
  deformation = start_deformation;
  cell = cell_at(deformation);
  records.resize(n);
  for (std::size_t q = 0; q < n; ++q) {
    records[q] = {};
    records[q].radius = p.packing->radius[q];
  }
  const std::size_t rows = p.space->finds_deformation ? dim : 0;
  forces.resize(nodes() + rows);
  mass_records.resize(nodes() + rows);
  stiffness_.resize(nodes());
  node_residual.resize(unknowns());
  mass.resize(unknowns());
  node_radius.resize(nodes());
  for (std::size_t q = 0; q < n; ++q) {
    node_radius[static_cast<std::size_t>(p.space->node[q])] = p.packing->radius[q];
  }
  find_least_masses();
  const double radius = mean_radius(p.packing->radius);
  gap_ = tuned::listing_gap * radius;
  const double largest_radius = *std::max_element(node_radius.begin(), node_radius.end());
  double extent = 0;
  for (std::size_t k = 0; k < dim * n; ++k) extent = std::max(extent, std::abs(start[k]));
  rounding_force_ = tuned::contacts_of_a_particle * std::numeric_limits<double>::epsilon() *
                    extent * p.law->stiffness(largest_radius, largest_radius);
  dissipated = 0;
  broken_bonds = 0;
  mean_force = 0;
  touching = 0;
  relaxation_steps = servo_corrections = 0;
  factorisations = 0;
  mean_branch_ = 2 * radius;
  deformation_scale_ = p.space->reference_volume / (p.packing->thickness * mean_branch_);
  if (!p.space->identity) {
    for (std::size_t q = 0; q < nodes(); ++q) mass_records[q] = mass_of({}, least_masses_[q], 1);
    find_average_masses();
  }
  deform(target);
}

template <int D>
void Increment<D>::deform(const Tensor<D>& target) {
  released_ = false;
  after_break_ = false;
  const auto& space = *problem->space;
  auto to = target;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) to[k] = deformation[k];  // until it is found
  }
  carry_affinely(deformation, to, coordinates);
  deformation = to;
  if (!space.bound_to_axes()) cell = cell_at(deformation);
  if (!space.identity) place_fixed();
  list_neighbours();
}

// Moves positions affinely from one F to another; where the space is bound to axes, fluctuations keep
// their components.
template <int D>
void Increment<D>::carry_affinely(const Tensor<D>& from, const Tensor<D>& to,
                                  std::vector<double>& positions) const {
  const auto n = particles();
  if (problem->space->bound_to_axes()) {
    Tensor<D> change{};
    for (std::size_t k = 0; k < squared<D>; ++k) change[k] = to[k] - from[k];
    move_with<D>(problem->space->reference.data(), change, n, positions.data());
    return;
  }
  map_positions<D>(product<D>(to, inverse<D>(from)), n, positions.data());
}

// Where F has a particle that does not fluctuate.
template <int D>
double Increment<D>::affine_place(std::size_t p, std::size_t direction) const {
  const auto& space = *problem->space;
  const bool bound = space.bound_to_axes();
  const double* x = bound ? space.reference.data() : problem->packing->position.data();
  const auto n = particles();
  const double offset = bound ? space.offset[direction * n + p] : 0;
  return dot<D>(deformation.data() + dim * direction, x + p, n) + offset;
}

template <int D>
Vec<D> Increment<D>::drift() const {
  Vec<D> result{};
  for (std::size_t k = 0; k < dim; ++k) {
    const int anchor = problem->space->anchor[k];
    if (anchor < 0) continue;
    const auto p = static_cast<std::size_t>(anchor);
    result[k] = coordinates[k * particles() + p] - affine_place(p, k);
  }
  return result;
}

// No rounding adds up from increment to increment: prescribed particles are where F puts them,
// boundary particles average to F, and what may move as a whole goes back.
template <int D>
void Increment<D>::place_fixed() {
  const auto& space = *problem->space;
  const auto n = particles();
  const auto moved = drift();
  for (std::size_t k = 0; k < dim; ++k) {
    double* x = coordinates.data() + k * n;
    for (std::size_t p = 0; p < n; ++p) {
      const bool fixed = (space.fixed[static_cast<std::size_t>(space.node[p])] & fixed_bit(k)) != 0;
      x[p] = fixed ? affine_place(p, k) : x[p] - moved[k];
    }
  }
}

template <int D>
void Increment<D>::load_records() {
  grainlaw::core::load_records(coordinates.data(), problem->law->rotating(), std::span(records));
}

template <int D>
void Increment<D>::store_records() {
  grainlaw::core::store_records(std::span<const ParticleRecord<D>>(records),
                                problem->law->rotating(), coordinates.data());
}

template <int D>
void Increment<D>::update_forces() {
  load_records();
  evaluate_contacts<D>(records, *problem->law, contacts, forces);
  project();
}

template <int D>
void Increment<D>::update_forces_advancing() {
  load_records();
  dissipated += advance_contacts<D>(records, *problem->law, contacts, forces);
  restart_turns();
  project();
}

template <int D>
void Increment<D>::project() {
  reduce(forces);
  put_residual(forces.data(), node_radius, problem->law->rotating(), node_residual.data());
  if (!problem->space->finds_deformation) return;
  double* of_rows = node_residual.data() + node_unknowns();
  for (std::size_t i = 0; i < dim; ++i) {
    std::copy_n(&forces[nodes() + i].x, dim, of_rows + dim * i);
  }
}

template <int D>
double Increment<D>::overlap(std::size_t c) const {
  return contacts.rest_of(c) - std::sqrt(branch_square(c));
}

template <int D>
double Increment<D>::relative_scale() const {
  return std::max(mean_force, problem->force_floor);
}

template <int D>
double Increment<D>::residual_norm() const {
  if (touching == 0) return std::numeric_limits<double>::infinity();
  const auto m = nodes();
  const double* r = residual().data();
  double largest = 0;
  double sum = 0;  // catches NaN, which max does not
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::size_t q = 0; q < dim * m; ++q) {
    largest = std::max(largest, std::abs(r[q]));
    sum += r[q];
  }
  if (problem->law->rotating()) {
    const double* moment = r + dim * m;
    const double* radius = node_radius.data();
    for (std::size_t k = 0; k < spins; ++k, moment += m) {
#pragma omp simd reduction(max : largest) reduction(+ : sum)
      for (std::size_t q = 0; q < m; ++q) {
        const double force = moment[q] / radius[q];
        largest = std::max(largest, std::abs(force));
        sum += force;
      }
    }
  }
  if (problem->space->finds_deformation) {
    for (std::size_t k = node_unknowns(); k < unknowns(); ++k) {
      largest = std::max(largest, std::abs(r[k]));
      sum += r[k];
    }
    if (!(determinant<D>(deformation) > 0)) return std::numeric_limits<double>::infinity();
  }
  if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  return largest / relative_scale();
}

template <int D>
void Increment<D>::move(std::span<const double> step, double factor) {
  const auto& space = *problem->space;
  const auto n = particles();
  const auto m = nodes();
  for (std::size_t k = 0; k < dim; ++k) {
    const double* dz = step.data() + k * m;
    double* z = coordinates.data() + k * n;
    for (std::size_t p = 0; p < n; ++p) z[p] += factor * dz[space.node[p]];
  }
  if (problem->law->rotating()) {
    add_spins<D>(step.data() + dim * m, m, space.node, factor, coordinates.data() + dim * n);
  }
  if (!space.finds_deformation) return;
  Tensor<D> change{};
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) change[k] = factor * step[node_unknowns() + k] / deformation_scale_;
    deformation[k] += change[k];
  }
  move_with<D>(space.reference.data(), change, n, coordinates.data());
}

template <int D>
void Increment<D>::restart_turns() {
  if (!problem->law->rotating()) return;
  turned_.restart(records, coordinates.data() + dim * particles());
}

template class Increment<2>;
template class Increment<3>;

}  // namespace grainlaw::core

#include "increment/increment.hpp"

#include "base/room.hpp"
#include "contact/frictional.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

namespace {

// Neighbours are listed within this gap, in mean radii: wide enough that an increment of 0.1 %
// rarely lists twice, narrow enough that few listed pairs never touch.
constexpr double gap_in_radii = 0.1;
// Whose rounding errors add up in a residual.
constexpr double contacts_of_a_particle = 8;

std::array<double, 4> product(const std::array<double, 4>& a, const double* b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

std::array<double, 4> inverse(const std::array<double, 4>& a) {
  const double det = a[0] * a[3] - a[1] * a[2];
  return {a[3] / det, -a[1] / det, -a[2] / det, a[0] / det};
}

// Affine motion of reference positions, added to x.
void move_with(const double* reference, const std::array<double, 4>& change, std::size_t n,
               double* x) {
  for (std::size_t p = 0; p < n; ++p) {
    const double a = reference[p];
    const double b = reference[n + p];
    x[p] += change[0] * a + change[1] * b;
    x[n + p] += change[2] * a + change[3] * b;
  }
}

}  // namespace

std::array<double, 4> Increment::cell_at(const std::array<double, 4>& f) const {
  if (problem->packing->frame) return {};
  return product(f, problem->packing->cell.data());
}

void Increment::begin(const Problem& p, const Configuration& from,
                      const std::array<double, 4>& target) {
  problem = &p;
  const auto n = particles();
  const auto components = static_cast<std::size_t>(p.components());
  start.resize(n * components);
  std::copy_n(from.coordinates.begin(), 2 * n, start.begin());
  std::fill(start.begin() + static_cast<std::ptrdiff_t>(2 * n), start.end(), 0.0);
  start_deformation = {from.deformation[0], from.deformation[1], from.deformation[2],
                       from.deformation[3]};
  copy_with_room(from.contacts, history);
  copy_with_room(from.moments, history_moments);
  copy_with_room(from.bond_gaps, history_gaps);
  coordinates = start;
  deformation = start_deformation;
  cell = cell_at(deformation);
  records.resize(n);
  for (std::size_t q = 0; q < n; ++q) records[q] = {0, 0, 0, p.packing->radius[q]};
  const std::size_t rows = p.space->finds_deformation ? 2 : 0;
  forces.resize(nodes() + rows);
  mass_records.resize(nodes() + rows);
  node_residual.resize(unknowns());
  mass.resize(unknowns());
  node_radius.resize(nodes());
  for (std::size_t q = 0; q < n; ++q) {
    node_radius[static_cast<std::size_t>(p.space->node[q])] = p.packing->radius[q];
  }
  find_least_masses();
  double mean_radius = 0;
  for (const double r : p.packing->radius) mean_radius += r / static_cast<double>(n);
  gap_ = gap_in_radii * mean_radius;
  const double largest_radius = *std::max_element(node_radius.begin(), node_radius.end());
  double extent = 0;
  for (std::size_t k = 0; k < 2 * n; ++k) extent = std::max(extent, std::abs(start[k]));
  rounding_force_ = contacts_of_a_particle * std::numeric_limits<double>::epsilon() * extent *
                    p.law->stiffness(largest_radius, largest_radius);
  dissipated = 0;
  broken_bonds = 0;
  mean_force = 0;
  touching = 0;
  relaxation_steps = servo_corrections = 0;
  factorisations = 0;
  mean_branch_ = 2 * mean_radius;
  deformation_scale_ = p.space->reference_volume / (p.packing->thickness * mean_branch_);
  if (!p.space->identity) {
    std::copy(least_masses_.begin(), least_masses_.end(), mass_records.begin());
    find_average_masses();
  }
  deform(target);
}

void Increment::deform(const std::array<double, 4>& target) {
  released_ = false;
  after_break_ = false;
  const auto& space = *problem->space;
  auto to = target;
  for (std::size_t k = 0; k < 4; ++k) {
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
void Increment::carry_affinely(const std::array<double, 4>& from, const std::array<double, 4>& to,
                               std::vector<double>& positions) const {
  const auto n = particles();
  double* x = positions.data();
  if (problem->space->bound_to_axes()) {
    std::array<double, 4> change{};
    for (std::size_t k = 0; k < 4; ++k) change[k] = to[k] - from[k];
    move_with(problem->space->reference.data(), change, n, x);
    return;
  }
  const auto g = product(to, inverse(from).data());
  double* y = x + n;
  for (std::size_t p = 0; p < n; ++p) {
    const double a = x[p];
    const double b = y[p];
    x[p] = g[0] * a + g[1] * b;
    y[p] = g[2] * a + g[3] * b;
  }
}

// Where F has a particle that does not fluctuate.
double Increment::affine_place(std::size_t p, std::size_t direction) const {
  const auto& space = *problem->space;
  const bool bound = space.bound_to_axes();
  const double* x = bound ? space.reference.data() : problem->packing->position.data();
  const auto n = particles();
  const double offset = bound ? space.offset[direction * n + p] : 0;
  return deformation[2 * direction] * x[p] + deformation[2 * direction + 1] * x[n + p] + offset;
}

std::array<double, 2> Increment::drift() const {
  std::array<double, 2> result{};
  for (std::size_t k = 0; k < 2; ++k) {
    const int anchor = problem->space->anchor[k];
    if (anchor < 0) continue;
    const auto p = static_cast<std::size_t>(anchor);
    result[k] = coordinates[k * particles() + p] - affine_place(p, k);
  }
  return result;
}

// No rounding adds up from increment to increment: prescribed particles are where F puts them,
// boundary particles average to F, and what may move as a whole goes back.
void Increment::place_fixed() {
  const auto& space = *problem->space;
  const auto n = particles();
  const auto moved = drift();
  for (std::size_t k = 0; k < 2; ++k) {
    double* x = coordinates.data() + k * n;
    const auto bit = k == 0 ? fixed_x : fixed_y;
    for (std::size_t p = 0; p < n; ++p) {
      const bool fixed = (space.fixed[static_cast<std::size_t>(space.node[p])] & bit) != 0;
      x[p] = fixed ? affine_place(p, k) : x[p] - moved[k];
    }
  }
}

void Increment::load_records() {
  const auto n = particles();
  const double* x = coordinates.data();
  const double* y = x + n;
  const double* rotation = problem->law->rotating() ? y + n : nullptr;
  for (std::size_t p = 0; p < n; ++p) {
    auto& record = records[p];
    record.x = x[p];
    record.y = y[p];
    if (rotation) record.roll = record.radius * rotation[p];
  }
}

void Increment::store_records() {
  const auto n = particles();
  double* x = coordinates.data();
  double* y = x + n;
  double* rotation = problem->law->rotating() ? y + n : nullptr;
  for (std::size_t p = 0; p < n; ++p) {
    const auto& record = records[p];
    x[p] = record.x;
    y[p] = record.y;
    if (rotation) rotation[p] = record.roll / record.radius;
  }
}

void Increment::update_forces() {
  load_records();
  evaluate_contacts(records, *problem->law, contacts, forces);
  project();
}

void Increment::update_forces_advancing() {
  load_records();
  dissipated += advance_contacts(records, *problem->law, contacts, forces);
  project();
}

void Increment::project() {
  const auto m = nodes();
  reduce(forces);
  double* r = node_residual.data();
  for (std::size_t q = 0; q < m; ++q) {
    r[q] = forces[q].x;
    r[m + q] = forces[q].y;
  }
  if (problem->space->finds_deformation) {
    double* of_rows = r + node_unknowns();
    for (std::size_t i = 0; i < 2; ++i) {
      of_rows[2 * i] = forces[m + i].x;
      of_rows[2 * i + 1] = forces[m + i].y;
    }
  }
  if (!problem->law->rotating()) return;
  for (std::size_t q = 0; q < m; ++q) r[2 * m + q] = forces[q].roll * node_radius[q];
}

double Increment::overlap(std::size_t c) const {
  return contacts.rest_of(c) - std::sqrt(branch_square(c));
}

double Increment::relative_scale() const { return std::max(mean_force, problem->force_floor); }

double Increment::residual_norm() const {
  if (touching == 0) return std::numeric_limits<double>::infinity();
  const auto m = nodes();
  const double* r = residual().data();
  double largest = 0;
  double sum = 0;  // catches NaN, which max does not
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::size_t q = 0; q < 2 * m; ++q) {
    largest = std::max(largest, std::abs(r[q]));
    sum += r[q];
  }
  if (problem->law->rotating()) {
    const double* moment = r + 2 * m;
    const double* radius = node_radius.data();
#pragma omp simd reduction(max : largest) reduction(+ : sum)
    for (std::size_t q = 0; q < m; ++q) {
      const double force = moment[q] / radius[q];
      largest = std::max(largest, std::abs(force));
      sum += force;
    }
  }
  if (problem->space->finds_deformation) {
    for (std::size_t k = node_unknowns(); k < unknowns(); ++k) {
      largest = std::max(largest, std::abs(r[k]));
      sum += r[k];
    }
    if (!(deformation[0] * deformation[3] - deformation[1] * deformation[2] > 0)) {
      return std::numeric_limits<double>::infinity();
    }
  }
  if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  return largest / relative_scale();
}

void Increment::move(std::span<const double> step, double factor) {
  const auto& space = *problem->space;
  if (space.identity) {
    double* z = coordinates.data();
    const double* dz = step.data();
    for (std::size_t k = 0; k < step.size(); ++k) z[k] += factor * dz[k];
    return;
  }
  const auto n = particles();
  const auto m = nodes();
  for (std::size_t k = 0; k < node_unknowns() / m; ++k) {
    const double* dz = step.data() + k * m;
    double* z = coordinates.data() + k * n;
    for (std::size_t p = 0; p < n; ++p) z[p] += factor * dz[space.node[p]];
  }
  if (!space.finds_deformation) return;
  std::array<double, 4> change{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (space.found[k]) change[k] = factor * step[node_unknowns() + k] / deformation_scale_;
    deformation[k] += change[k];
  }
  move_with(space.reference.data(), change, n, coordinates.data());
}

}  // namespace grainlaw

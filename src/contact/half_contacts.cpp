// Half contacts: what discs and spheres share. Their loops differ.
#include "contact/half_contacts.hpp"

#include "base/capacity.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw::core {

namespace {

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

double spin_of(const LeastMass<2>& least) { return least.roll; }
double spin_of(const LeastMass<3>& least) { return least.spin; }
double spin_of(const MassRecord<2>& stiffness) { return stiffness.roll; }
double spin_of(const MassRecord<3>& stiffness) { return stiffness.spin_x; }

}  // namespace

template <int D>
void HalfContacts<D>::arrange(const ContactList<D>& list, const Packing& packing,
                              std::span<const LeastMass<D>> least_masses, bool at_rest) {
  const auto& radius = packing.radius;
  particles_ = packing.size();
  const double sum = std::accumulate(radius.begin(), radius.end(), 0.0);
  curvature_ = 0.5 * static_cast<double>(particles_) / sum;
  if (!at_rest) {
    resize_with_capacity(velocity_, particles_);
    for (std::size_t p = 0; p < particles_; ++p) velocity_[p] = velocity(p);
  }
  slots_.sort(std::span(list.i).first(list.size()), std::span(list.j).first(list.size()),
              particles_, packing.order);
  resize_with_capacity(nodes_, slots_.groups().size());
  std::fill(nodes_.begin(), nodes_.end(), Nodes{});
  bound_masses(least_masses);
  for (auto* records : {&positions_, &displacements_, &last_displacements_}) {
    resize_with_capacity(*records, lanes * nodes_.size());
    std::fill(records->begin(), records->end(), ParticleRecord<D>{});
  }
  if (!at_rest) {
    for (std::size_t p = 0; p < particles_; ++p) set_velocity(p, velocity_[p]);
  }
  const double largest = *std::max_element(radius.begin(), radius.end());
  if constexpr (D == 3) {  // what divides by a radius finds one in the padding too
    for (auto& record : positions_) record.radius = largest;
  }
  list_half_contacts(list, 2 * largest);
}

template <int D>
void HalfContacts<D>::bound_masses(std::span<const LeastMass<D>> least_masses) {
  Bounds padding{};
  for (auto* column : {&padding.least, &padding.least_spin}) std::fill_n(*column, lanes, 1.0);
  resize_with_capacity(bounds_, nodes_.size());
  std::fill(bounds_.begin(), bounds_.end(), padding);
  for (std::size_t p = 0; p < particles_; ++p) {
    const std::size_t slot = slots_.slot(p);
    const std::size_t k = slot % lanes;
    Bounds& bounds = bounds_[slot / lanes];
    bounds.least[k] = least_masses[p].x;
    bounds.least_spin[k] = spin_of(least_masses[p]);
    bounds.inverse_radius[k] = least_masses[p].inverse_radius;
  }
}

template <int D>
void HalfContacts<D>::list_half_contacts(const ContactList<D>& list, double longest_reach) {
  // Padding: nodes beside themselves beyond their reach, without stiffness.
  Start padding{};
  std::fill_n(padding.offset[0], lanes, 2 * longest_reach);
  std::fill_n(padding.inverse_reach, lanes, 1 / longest_reach);
  std::fill_n(padding.normal[0], lanes, 1.0);
  resize_with_capacity(starts_, slots_.row_count());
  std::fill(starts_.begin(), starts_.end(), padding);
  resize_with_capacity(half_contacts_, slots_.row_count());
  std::fill(half_contacts_.begin(), half_contacts_.end(), HalfContact{});
  std::int32_t first = 0;
  for (const auto& group : slots_.groups()) {
    for (std::size_t row = group.first; row < group.first + group.count; ++row) {
      std::iota(half_contacts_[row].other, half_contacts_[row].other + lanes, first);
    }
    first += lanes;
  }
  // Forces of spheres are vectors and change sign with the node; those of discs count along the
  // tangent, which turns with it.
  const auto add = [&](std::size_t c, std::int32_t node, std::int32_t other, double sign) {
    const std::size_t row = slots_.next_row(at(node));
    const std::size_t k = slots_.slot(at(node)) % lanes;
    Start& start = starts_[row];
    start.inverse_reach[k] = list.inverse_reach[c];
    for (std::size_t m = 0; m < D; ++m) {
      start.offset[m][k] = sign * list.offset[m][c];
      start.normal[m][k] = sign * list.start_normal[m][c];
    }
    for (std::size_t m = 0; m < Columns::tangents; ++m) {
      start.force[m][k] = (D == 3 ? sign : 1) * list.start_force[m][c];
    }
    if constexpr (D == 2) start.spin[k] = list.start_roll[c];
    HalfContact& half = half_contacts_[row];
    half.other[k] = static_cast<std::int32_t>(slots_.slot(at(other)));
    half.normal_stiffness[k] = list.normal_stiffness[c];
  };
  for (std::size_t c = 0; c < list.size(); ++c) {
    add(c, list.i[c], list.j[c], -1);
    add(c, list.j[c], list.i[c], 1);
  }
}

template <int D>
void HalfContacts<D>::add_drag(std::span<const ParticleRecord<D>> particles,
                               const NodeDrag<D>& drag, double factor) {
  resize_with_capacity(drags_, nodes_.size());
  std::fill(drags_.begin(), drags_.end(), Drag{});
  for (std::size_t p = 0; p < particles_; ++p) {
    const std::size_t slot = slots_.slot(p);
    const std::size_t k = slot % lanes;
    Drag& of = drags_[slot / lanes];
    of.stiffness[k] = drag.stiffness[p].x;
    of.stiffness_spin[k] = spin_of(drag.stiffness[p]);
    for (std::size_t c = 0; c < components; ++c) {
      of.distance[c][k] = component(drag.expected[p], c) - component(particles[p], c);
    }
    Nodes& nodes = nodes_[slot / lanes];
    nodes.mass[k] += factor * of.stiffness[k];
    nodes.gain[k] = 1 / nodes.mass[k];
    nodes.mass_spin[k] += factor * of.stiffness_spin[k];
    nodes.gain_spin[k] = 1 / nodes.mass_spin[k];
  }
}

#define GRAINLAW_FOR(D)                                                                           \
  template void HalfContacts<D>::arrange(const ContactList<D>&, const Packing&,                   \
                                         std::span<const LeastMass<D>>, bool);                    \
  template void HalfContacts<D>::add_drag(std::span<const ParticleRecord<D>>, const NodeDrag<D>&, \
                                          double);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

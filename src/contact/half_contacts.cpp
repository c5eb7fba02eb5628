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
                              std::span<const LeastMass<D>> least_masses,
                              std::span<const ParticleRecord<D>> particles, bool at_rest) {
  const auto& radius = packing.radius;
  particles_ = packing.size();
  const double sum = std::accumulate(radius.begin(), radius.end(), 0.0);
  curvature_ = 0.5 * static_cast<double>(particles_) / sum;
  if (!at_rest) {
    resize_with_capacity(velocity_, particles_);
    for (std::size_t p = 0; p < particles_; ++p) velocity_[p] = velocity(p);
  }
  if constexpr (D == 3) {
    measure_moves();
    if (at_rest) moved_ = 0;
    find_near(list, particles);
  }
  slots_.sort(std::span(list.i).first(list.size()), std::span(list.j).first(list.size()),
              particles_, packing.order, near_);
  const std::size_t groups = slots_.groups().size();
  resize_with_capacity(bounds_, groups);
  bound_masses(least_masses);
  resize_with_capacity(positions_, lanes * groups);
  std::fill(positions_.begin(), positions_.end(), ParticleRecord<D>{});
  const auto begin = [&]<class Real>(Steps<Real>& steps) {
    resize_with_capacity(steps.nodes, groups);
    std::fill(steps.nodes.begin(), steps.nodes.end(), typename Columns::template NodesOf<Real>{});
    for (auto* records : {&steps.displacements, &steps.last_displacements}) {
      resize_with_capacity(*records, lanes * groups);
      std::fill(records->begin(), records->end(), typename Columns::template Displacement<Real>{});
    }
    resize_with_capacity(steps.half_contacts, slots_.row_count());
  };
  begin(steps_);
  if constexpr (D == 3) begin(single_);
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
  if constexpr (D == 2) {
    std::fill(steps_.half_contacts.begin(), steps_.half_contacts.end(),
              typename Columns::HalfContact{});
  }
  auto& partners = [this]() -> auto& {
    if constexpr (D == 2) {
      return steps_.half_contacts;
    } else {
      return starts_;
    }
  }
  ();
  std::int32_t first = 0;
  for (const auto& group : slots_.groups()) {
    for (std::size_t row = group.first; row < group.first + group.count; ++row) {
      std::iota(partners[row].other, partners[row].other + lanes, first);
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
    partners[row].other[k] = static_cast<std::int32_t>(slots_.slot(at(other)));
    partners[row].normal_stiffness[k] = list.normal_stiffness[c];
  };
  const auto add_all = [&](auto&& wanted) {
    for (std::size_t c = 0; c < list.size(); ++c) {
      if (!wanted(c)) continue;
      add(c, list.i[c], list.j[c], -1);
      add(c, list.j[c], list.i[c], 1);
    }
  };
  if (near_.empty()) return add_all([](std::size_t /*c*/) { return true; });
  add_all([this](std::size_t c) { return near_[c] != 0; });
  add_all([this](std::size_t c) { return near_[c] == 0; });
}

template <int D>
void HalfContacts<D>::add_drag(std::span<const ParticleRecord<D>> particles,
                               const NodeDrag<D>& drag, double factor) {
  with_steps([&]<class Real>(Steps<Real>& steps) {
    resize_with_capacity(steps.drags, steps.nodes.size());
    std::fill(steps.drags.begin(), steps.drags.end(), typename Columns::template DragOf<Real>{});
    for (std::size_t p = 0; p < particles_; ++p) {
      const std::size_t slot = slots_.slot(p);
      const std::size_t k = slot % lanes;
      auto& of = steps.drags[slot / lanes];
      of.stiffness[k] = static_cast<Real>(drag.stiffness[p].x / steps.stiffness);
      of.stiffness_spin[k] = static_cast<Real>(spin_of(drag.stiffness[p]) / steps.stiffness);
      for (std::size_t c = 0; c < components; ++c) {
        const double distance = component(drag.expected[p], c) - component(particles[p], c);
        of.distance[c][k] = static_cast<Real>(distance / steps.length);
      }
      auto& nodes = steps.nodes[slot / lanes];
      const Real share = static_cast<Real>(factor);
      nodes.mass[k] += share * of.stiffness[k];
      nodes.gain[k] = 1 / nodes.mass[k];
      nodes.mass_spin[k] += share * of.stiffness_spin[k];
      nodes.gain_spin[k] = 1 / nodes.mass_spin[k];
    }
  });
}

#define GRAINLAW_FOR(D)                                                                           \
  template void HalfContacts<D>::arrange(const ContactList<D>&, const Packing&,                   \
                                         std::span<const LeastMass<D>>,                           \
                                         std::span<const ParticleRecord<D>>, bool);               \
  template void HalfContacts<D>::add_drag(std::span<const ParticleRecord<D>>, const NodeDrag<D>&, \
                                          double);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

// Half contacts: what discs and spheres share. Their loops differ.
#include "contact/half_contacts.hpp"

#include "base/capacity.hpp"
#include "contact/half_contact_steps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainlaw::core {

namespace {

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

double spin_of(const LeastMass<2>& least) { return least.roll; }
double spin_of(const LeastMass<3>& least) { return least.spin; }
double spin_of(const MassRecord<2>& stiffness) { return stiffness.roll; }
double spin_of(const MassRecord<3>& stiffness) { return stiffness.spin_x; }

// Power of two that is at most this number, so that units do not round.
double power_of_two(double number) { return std::ldexp(1.0, std::ilogb(number)); }

}  // namespace

template <int D>
void HalfContacts<D>::arrange(const ContactList<D>& list, const Packing& packing,
                              std::span<const LeastMass<D>> least_masses,
                              std::span<const ParticleRecord<D>> particles, bool at_rest,
                              bool may_be_single) {
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
  single_precision_ = single_precision_ && may_be_single;
  choose_units(list);
  slots_.sort(std::span(list.i).first(list.size()), std::span(list.j).first(list.size()),
              particles_, packing.order, near_);
  const std::size_t groups = slots_.groups().size();
  resize_with_capacity(bounds_, groups);
  bound_masses(least_masses);
  resize_with_capacity(positions_, lanes * groups);
  std::fill(positions_.begin(), positions_.end(), ParticleRecord<D>{});
  begin(steps_);
  if (may_be_single) begin(single_);
  if (!at_rest) {
    for (std::size_t p = 0; p < particles_; ++p) set_velocity(p, velocity_[p]);
  }
  const double largest = *std::max_element(radius.begin(), radius.end());
  if constexpr (D == 3) {  // what divides by a radius finds one in the padding too
    for (auto& record : positions_) record.radius = largest;
  }
  list_half_contacts(list, 2 * largest);
}

// Takes nodes at rest, and room for half contacts.
template <int D>
template <class Real>
void HalfContacts<D>::begin(Steps<Real>& steps) {
  const std::size_t groups = slots_.groups().size();
  resize_with_capacity(steps.nodes, groups);
  std::fill(steps.nodes.begin(), steps.nodes.end(), typename Columns::template NodesOf<Real>{});
  for (auto* records : {&steps.displacements, &steps.last_displacements}) {
    resize_with_capacity(*records, lanes * groups);
    std::fill(records->begin(), records->end(), Displacement<Real>{});
  }
  resize_with_capacity(steps.half_contacts, slots_.row_count());
}

template <int D>
auto HalfContacts<D>::velocity(std::size_t particle) const -> Velocity {
  const std::size_t slot = slots_.slot(particle);
  Velocity result{};
  with_steps([&](const auto& steps) {
    for (std::size_t c = 0; c < components; ++c) {
      result[c] = steps.length * steps.nodes[slot / lanes].velocity[c][slot % lanes];
    }
  });
  return result;
}

template <int D>
void HalfContacts<D>::set_velocity(std::size_t particle, const Velocity& velocity) {
  const std::size_t slot = slots_.slot(particle);
  with_steps([&]<class Real>(Steps<Real>& steps) {
    for (std::size_t c = 0; c < components; ++c) {
      steps.nodes[slot / lanes].velocity[c][slot % lanes] =
          static_cast<Real>(velocity[c] / steps.length);
    }
  });
}

// Updates the largest displacement if there is one.
template <int D>
void HalfContacts<D>::measure_moves() {
  with_steps([this]<class Real>(const Steps<Real>& steps) {
    Real largest = 0;
    for (const auto& nodes : steps.nodes) {
      for (const auto& moved : nodes.moved) {
        for (const Real value : moved) largest = std::max(largest, std::abs(value));
      }
    }
    if (largest > 0) moved_ = steps.length * static_cast<double>(largest);
  });
}

template <int D>
void HalfContacts<D>::step_in_single_precision(bool single) {
  if (single == single_precision_) return;
  if constexpr (D == 3) measure_moves();
  const auto carry = []<class From, class To>(const Steps<From>& from, Steps<To>& to) {
    for (std::size_t g = 0; g < from.nodes.size(); ++g) {
      for (std::size_t c = 0; c < components; ++c) {
        const auto& velocity = from.nodes[g].velocity[c];
        std::transform(velocity, velocity + lanes, to.nodes[g].velocity[c], [&](From value) {
          return static_cast<To>(value * (from.length / to.length));
        });
        std::fill_n(to.nodes[g].moved[c], lanes, To(0));
      }
    }
  };
  if (single) {
    carry(steps_, single_);
  } else {
    carry(single_, steps_);
  }
  single_precision_ = single;
}

// Counts displacements from the present positions on, without drag.
template <int D>
template <class Real>
void HalfContacts<D>::restart(Steps<Real>& steps) {
  for (auto& nodes : steps.nodes) std::fill_n(nodes.moved[0], components * lanes, Real(0));
  std::fill(steps.displacements.begin(), steps.displacements.end(), Displacement<Real>{});
  steps.drags.clear();
}

template <int D>
StepMeasures HalfContacts<D>::step(const ContactLaw& law, double keep, double gain) {
  return with_steps([&]<class Real>(Steps<Real>& steps) {
    const half_contact_steps::Step<D, Real> next{
        .groups = D == 3 ? std::span<const HalfContactRows>(near_rows_) : slots_.groups(),
        .drags = steps.drags.empty() ? nullptr : steps.drags.data(),
        .half_contacts = steps.half_contacts.data(),
        .nodes = steps.nodes.data(),
        .displacements = steps.displacements[0].component,
        .next_displacements = steps.last_displacements[0].component,
        .curvature = static_cast<Real>(curvature_ * steps.length),
        .friction = static_cast<Real>(law.friction),
        .ratio = static_cast<Real>(law.ratio),
        .keep = static_cast<Real>(keep),
        .gain = static_cast<Real>(gain)};
    const StepMeasures measures = half_contact_steps::take_step(next, law.rotating());
    steps.displacements.swap(steps.last_displacements);
    const double force = steps.stiffness * steps.length;
    const double energy = force * steps.length;
    return StepMeasures{force * measures.largest, energy * measures.power,
                        energy * measures.next_power, energy * measures.inertia};
  });
}

template <int D>
void HalfContacts<D>::choose_units(const ContactList<D>& list) {
  const auto stiffness = std::span(list.normal_stiffness).first(list.size());
  const double sum = std::accumulate(stiffness.begin(), stiffness.end(), 0.0);
  mean_stiffness_ = list.size() > 0 ? sum / static_cast<double>(list.size()) : 1;
  single_.length = power_of_two(0.5 / curvature_);
  single_.stiffness = power_of_two(mean_stiffness_);
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
  std::int32_t first = 0;
  for (const auto& group : slots_.groups()) {
    for (std::size_t row = group.first; row < group.first + group.count; ++row) {
      std::iota(starts_[row].other, starts_[row].other + lanes, first);
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
    start.other[k] = static_cast<std::int32_t>(slots_.slot(at(other)));
    start.normal_stiffness[k] = list.normal_stiffness[c];
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
  template void HalfContacts<D>::restart(Steps<double>&);                                         \
  template void HalfContacts<D>::restart(Steps<float>&);                                          \
  template void HalfContacts<D>::step_in_single_precision(bool);                                  \
  template StepMeasures HalfContacts<D>::step(const ContactLaw&, double, double);                 \
  template void HalfContacts<D>::measure_moves();                                                 \
  template void HalfContacts<D>::arrange(const ContactList<D>&, const Packing&,                   \
                                         std::span<const LeastMass<D>>,                           \
                                         std::span<const ParticleRecord<D>>, bool, bool);         \
  template void HalfContacts<D>::add_drag(std::span<const ParticleRecord<D>>, const NodeDrag<D>&, \
                                          double);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core

// Loops over half contacts of spheres, node by node: a relinearisation, and a step of a relaxation
// to first order around it.
#pragma once

#include "contact/half_contacts.hpp"
#include "contact/sphere_loops.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace grainlaw::core::sphere_half_contacts {

using namespace sphere_loops;
using Half = HalfContacts<3>;
constexpr std::size_t lanes = Half::lanes;
static_assert(lanes == ContactList<3>::group);

struct HalfContactLoop {
  std::span<const HalfContactSlots::Rows> groups;
  Half::Nodes* nodes;
  const Half::Bounds* bounds;
  const Half::Drag* drags = nullptr;
  const Half::Start* starts;
  Half::HalfContact* half_contacts;
  const double* records;                 // of the positions, or the displacements
  double* next_displacements = nullptr;  // out
  double friction = 0, ratio = 0, factor = 0, keep = 0, gain = 0;
};

struct Relinearised {
  double force, touching;
};

template <std::size_t width>
GRAINLAW_INLINE Triple<width> triple_at(const Half::Doubles* columns, std::size_t k) {
  return {load<width>(columns[0] + k), load<width>(columns[1] + k), load<width>(columns[2] + k)};
}
template <std::size_t width>
GRAINLAW_INLINE void put(const Triple<width>& value, Half::Doubles* columns, std::size_t k) {
  store(columns[0] + k, value.x);
  store(columns[1] + k, value.y);
  store(columns[2] + k, value.z);
}

template <std::size_t width, bool rotating>
GRAINLAW_INLINE Relinearised relinearise_loop(const HalfContactLoop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  GroupSum<width> force, touching;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactSlots::Rows rows = loop.groups[g];
    const Half::Bounds& bounds = loop.bounds[g];
    Half::Nodes& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes; k += width) {
      std::int32_t own_index[width];
      for (std::size_t l = 0; l < width; ++l) {
        own_index[l] = static_cast<std::int32_t>(lanes * g + k + l);
      }
      Geometry<width> at;
      at.j = spheres_at<width>(loop.records, own_index);
      V stiffness{}, stiffness_spin{};
      for (std::size_t row = rows.first; row < rows.first + rows.count; ++row) {
        const Half::Start& start = loop.starts[row];
        Half::HalfContact& half = loop.half_contacts[row];
        at.i = spheres_at<width>(loop.records, half.other + k);
        at.branch = sum(sum(at.j.position, -one, at.i.position), triple_at<width>(start.offset, k));
        at.square = dot(at.branch, at.branch) + tiny;
        at.distance = square_root(at.square);
        at.normal = product(1 / at.distance, at.branch);
        at.overlap = at.i.radius + at.j.radius - at.distance;
        const auto here = at.overlap > zero;
        const V kn = load<width>(half.normal_stiffness + k);
        const V fn = kn * at.overlap;
        const V kt = loop.ratio * kn;
        Triple<width> h = sum(triple_at<width>(start.force, k), kt * at.distance,
                              triple_at<width>(start.normal, k));
        if constexpr (rotating) h = rotated(at, h);
        const V stretch = at.distance * load<width>(start.inverse_reach + k);
        put(at.normal, half.normal, k);
        store(half.normal_force + k, fn);
        put(sum(h, -dot(at.normal, h), at.normal), half.trial, k);
        store(half.stretch + k, stretch);
        stiffness += here ? kn : zero;
        stiffness_spin += here ? kt * at.distance * stretch : zero;
        force.add(k, here ? fn : zero);
        touching.add(k, here ? one : zero);
      }
      const auto put_mass = [&](const V& sum, const double* least, double* mass, double* gain) {
        const V value = loop.factor * largest(sum, load<width>(least + k));
        store(mass + k, value);
        store(gain + k, 1 / value);
      };
      put_mass(stiffness, bounds.least, nodes.mass, nodes.gain);
      if constexpr (rotating) {
        put_mass(stiffness_spin * load<width>(bounds.inverse_radius + k), bounds.least_spin,
                 nodes.mass_spin, nodes.gain_spin);
      }
    }
  }
  return {force.total(), touching.total()};
}

template <std::size_t width, bool rotating, bool dragged>
GRAINLAW_INLINE StepMeasures step_loop(const HalfContactLoop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  V largest_force{};
  GroupSum<width> power, next_power, inertia;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactSlots::Rows rows = loop.groups[g];
    Half::Nodes& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes; k += width) {
      Triple<width> own = triple_at<width>(nodes.moved, k);
      Triple<width> own_spin = triple_at<width>(nodes.moved + 3, k);
      Triple<width> f{zero, zero, zero};
      Triple<width> tau{zero, zero, zero};
      const Half::HalfContact* half = loop.half_contacts + rows.first;
      for (const auto* const end = half + rows.count; half != end; ++half) {
        const auto first = disc_loops::records_of<width, 8>(loop.records, half->other + k);
        const Triple<width> u{own.x - first.x, own.y - first.y, own.z - first.roll};
        const Triple<width> n = triple_at<width>(half->normal, k);
        const V kn = load<width>(half->normal_stiffness + k);
        const V kt = loop.ratio * kn;
        const V along = dot(n, u);
        const V fn = largest(load<width>(half->normal_force + k) - kn * along, zero);
        Triple<width> moved = sum(u, -along, n);
        V stretch{};
        if constexpr (rotating) {
          const auto second = disc_loops::records_of<width, 8>(loop.records + 4, half->other + k);
          stretch = load<width>(half->stretch + k);
          const Triple<width> w{own_spin.x + first.last, own_spin.y + second.x,
                                own_spin.z + second.y};
          moved = sum(moved, -stretch, cross(w, n));
        }
        const Triple<width> trial = sum(triple_at<width>(half->trial, k), -kt, moved);
        const V bound = loop.friction * fn;
        const V size = square_root(dot(trial, trial) + tiny);
        const Triple<width> ft = product(smallest(bound / size, one), trial);
        f = sum(f, sum(ft, fn, n));
        if constexpr (rotating) tau = sum(tau, -stretch, cross(n, ft));
      }
      if constexpr (dragged) {
        const Half::Drag& drag = loop.drags[g];
        const auto pull = [&](const double* stiffness, const Half::Doubles* distance,
                              const Triple<width>& moved, Triple<width>& force) {
          const Triple<width> left = sum(triple_at<width>(distance, k), -one, moved);
          force = sum(force, load<width>(stiffness + k), left);
        };
        pull(drag.stiffness, drag.distance, own, f);
        if constexpr (rotating) pull(drag.stiffness_spin, drag.distance + 3, own_spin, tau);
      }
      V work{}, next_work{}, twice_energy{};
      const auto go_on = [&](const V& r, const double* mass, const double* gain, std::size_t c,
                             V& moved) {
        double* const velocity = nodes.velocity[c] + k;
        const V v = load<width>(velocity);
        largest_force = largest(largest_force, magnitude(r));
        work += v * r;
        twice_energy += v * load<width>(mass + k) * v;
        const V next = loop.keep * v + loop.gain * r * load<width>(gain + k);
        next_work += next * r;
        store(velocity, next);
        moved += next;
        store(nodes.moved[c] + k, moved);
      };
      go_on(f.x, nodes.mass, nodes.gain, 0, own.x);
      go_on(f.y, nodes.mass, nodes.gain, 1, own.y);
      go_on(f.z, nodes.mass, nodes.gain, 2, own.z);
      if constexpr (rotating) {
        go_on(tau.x, nodes.mass_spin, nodes.gain_spin, 3, own_spin.x);
        go_on(tau.y, nodes.mass_spin, nodes.gain_spin, 4, own_spin.y);
        go_on(tau.z, nodes.mass_spin, nodes.gain_spin, 5, own_spin.z);
      }
      power.add(k, work);
      next_power.add(k, next_work);
      inertia.add(k, twice_energy);
      put_records(own, own_spin, loop.next_displacements + 8 * (lanes * g + k));
    }
  }
  return {most(largest_force), power.total(), next_power.total(), inertia.total()};
}

}  // namespace grainlaw::core::sphere_half_contacts

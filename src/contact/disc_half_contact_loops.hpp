// Loops over half contacts, node by node: a relinearisation, and a step of a relaxation to first
// order around it.
#pragma once

#include "contact/disc_loops.hpp"
#include "contact/half_contacts.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core::disc_half_contacts {

using namespace simd;
using disc_loops::Columns;
using disc_loops::columns_at;
using disc_loops::GroupSum;
using disc_loops::put_records;
using disc_loops::records_of;
constexpr std::size_t lanes = HalfContacts<2>::lanes;
static_assert(lanes == ContactList<2>::group);

struct Loop {
  std::span<const HalfContactRows> groups;
  HalfContacts<2>::Nodes* nodes;
  const HalfContacts<2>::Bounds* bounds;
  const HalfContacts<2>::Drag* drags = nullptr;
  const HalfContacts<2>::Start* starts;
  HalfContacts<2>::HalfContact* half_contacts;
  const double* records;                 // of the positions, or the displacements
  double* last_displacements = nullptr;  // in: of the step before; out: of the next
  double curvature = 0, friction = 0, ratio = 0, factor = 0, keep = 0, gain = 0;
};

struct Relinearised {
  double beyond;  // > 0: a touching branch rotated beyond the short series
  double force, touching;
};

template <std::size_t width, bool rotating, bool far>
GRAINLAW_INLINE Relinearised relinearise_loop(const Loop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  const double ratio = loop.ratio;
  V beyond{};
  GroupSum<width> force, touching;
  const double* own_records = loop.records;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactRows rows = loop.groups[g];
    HalfContacts<2>::Nodes& nodes = loop.nodes[g];
    const HalfContacts<2>::Bounds& bounds = loop.bounds[g];
    for (std::size_t k = 0; k < lanes; k += width, own_records += 4 * width) {
      const Columns<width> own = columns_at<width>(own_records);
      V stiffness{}, stiffness_roll{};
      for (std::size_t row = rows.first; row < rows.first + rows.count; ++row) {
        const HalfContacts<2>::Start& start = loop.starts[row];
        HalfContacts<2>::HalfContact& half = loop.half_contacts[row];
        const Columns<width> other = records_of<width>(loop.records, half.other + k);
        const V x = own.x - other.x + load<width>(start.offset[0] + k);
        const V y = own.y - other.y + load<width>(start.offset[1] + k);
        const V distance = square_root(x * x + y * y + disc_loops::tiny);
        const V inverse = 1 / distance;
        const V overlap = own.last + other.last - distance;
        const auto here = overlap > zero;
        const V kn = load<width>(half.normal_stiffness + k);
        const V fn = kn * overlap;
        store(half.normal[0] + k, x * inverse);
        store(half.normal[1] + k, y * inverse);
        store(half.normal_force + k, fn);
        const V start_x = load<width>(start.normal[0] + k);
        const V start_y = load<width>(start.normal[1] + k);
        const V dot = start_x * x + start_y * y;
        const V cross = start_x * y - start_y * x;
        const V sine = cross * inverse;
        const V excess = dot > zero ? magnitude(sine) - short_series : one;
        beyond = largest(beyond, here ? excess : zero);
        V slip = distance;
        if constexpr (far) {
          slip *= far_angle(distance, dot, cross);
        } else {
          slip *= arc_sine(sine);
        }
        const V kt = ratio * kn;
        if constexpr (rotating) {
          const V stretch = distance * load<width>(start.inverse_reach + k);
          slip += stretch * (load<width>(start.spin + k) - (own.roll + other.roll));
          store(half.stretch + k, stretch);
          stiffness_roll += here ? kt * distance * stretch : zero;
        }
        store(half.trial[0] + k, load<width>(start.force[0] + k) - kt * slip);
        stiffness += here ? kn : zero;
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
        put_mass(stiffness_roll * load<width>(bounds.inverse_radius + k), bounds.least_spin,
                 nodes.mass_spin, nodes.gain_spin);
      }
    }
  }
  return {most(beyond), force.total(), touching.total()};
}

template <std::size_t width, bool rotating, bool dragged>
GRAINLAW_INLINE StepMeasures step_loop(const Loop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const double friction = loop.friction;
  const double ratio = loop.ratio;
  const double curvature = loop.curvature;
  V largest_force{};
  GroupSum<width> power, next_power, inertia;
  double* last_displacements = loop.last_displacements;
  const double* own_records = loop.records;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactRows rows = loop.groups[g];
    const HalfContacts<2>::Nodes& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes;
         k += width, last_displacements += 4 * width, own_records += 4 * width) {
      Columns<width> own = columns_at<width>(own_records);
      V x{}, y{}, roll{};
      const HalfContacts<2>::HalfContact* half = loop.half_contacts + rows.first;
      for (const auto* const end = half + rows.count; half != end; ++half) {
        const Columns<width> other = records_of<width>(loop.records, half->other + k);
        const V ux = own.x - other.x;
        const V uy = own.y - other.y;
        const V nx = load<width>(half->normal[0] + k);
        const V ny = load<width>(half->normal[1] + k);
        const V kn = load<width>(half->normal_stiffness + k);
        const V fn = largest(load<width>(half->normal_force + k) - kn * (nx * ux + ny * uy), zero);
        const V across = nx * uy - ny * ux;
        const V skew = curvature * across;
        const V ax = nx - skew * ny;
        const V ay = ny + skew * nx;
        V slip = across;
        V stretch{};
        if constexpr (rotating) {
          stretch = load<width>(half->stretch + k);
          slip -= stretch * (own.roll + other.roll);
        }
        const V trial = load<width>(half->trial[0] + k) - ratio * kn * slip;
        const V bound = friction * fn;
        const V ft = smallest(largest(trial, -bound), bound);
        x += fn * ax - ft * ay;
        y += fn * ay + ft * ax;
        if constexpr (rotating) roll -= stretch * ft;
      }
      if constexpr (dragged) {
        const HalfContacts<2>::Drag& drag = loop.drags[g];
        const V stiffness = load<width>(drag.stiffness + k);
        x += stiffness * (load<width>(drag.distance[0] + k) - own.x);
        y += stiffness * (load<width>(drag.distance[1] + k) - own.y);
        if constexpr (rotating) {
          roll +=
              load<width>(drag.stiffness_spin + k) * (load<width>(drag.distance[2] + k) - own.roll);
        }
      }
      V work{}, next_work{}, twice_energy{};
      const Columns<width> last = columns_at<width>(last_displacements);
      const auto go_on = [&](const V& force, const double* mass, const double* gain,
                             const V& before, V& moved) {
        const V v = moved - before;
        largest_force = largest(largest_force, magnitude(force));
        work += v * force;
        twice_energy += v * load<width>(mass + k) * v;
        const V next = loop.keep * v + loop.gain * force * load<width>(gain + k);
        next_work += next * force;
        moved += next;
      };
      go_on(x, nodes.mass, nodes.gain, last.x, own.x);
      go_on(y, nodes.mass, nodes.gain, last.y, own.y);
      if constexpr (rotating) go_on(roll, nodes.mass_spin, nodes.gain_spin, last.roll, own.roll);
      power.add(k, work);
      next_power.add(k, next_work);
      inertia.add(k, twice_energy);
      put_records<width>(own, last_displacements);
    }
  }
  return {most(largest_force), power.total(), next_power.total(), inertia.total()};
}

}  // namespace grainlaw::core::disc_half_contacts

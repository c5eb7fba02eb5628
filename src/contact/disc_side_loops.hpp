// Loops over half contacts, node by node: a relinearisation, and a step of a relaxation to first
// order around it.
#pragma once

#include "contact/disc_loops.hpp"
#include "contact/disc_sides.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core::disc_sides {

using namespace simd;
using disc_loops::Columns;
using disc_loops::columns_at;
using disc_loops::GroupSum;
using disc_loops::put_records;
using disc_loops::records_of;
constexpr std::size_t lanes = ContactSides<2>::lanes;
static_assert(lanes == ContactList<2>::group);

struct Loop {
  std::span<const SideSlots::Rows> groups;
  ContactSides<2>::Nodes* nodes;
  const ContactSides<2>::Bounds* bounds;
  const ContactSides<2>::Drag* drags = nullptr;
  const ContactSides<2>::Start* starts;
  ContactSides<2>::Side* sides;
  const double* records;         // of the positions, or the displacements
  double* last_moves = nullptr;  // in: of the step before; out: of the next
  double curvature = 0, friction = 0, ratio = 0, factor = 0, keep = 0, gain = 0;
};

struct Looked {
  double beyond;  // > 0: a touching branch rotated beyond the short series
  double force, touching;
};

template <std::size_t width, bool rotating, bool far>
GRAINLAW_INLINE Looked look_loop(const Loop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  const double ratio = loop.ratio;
  V beyond{};
  GroupSum<width> force, touching;
  const double* own_records = loop.records;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const SideSlots::Rows rows = loop.groups[g];
    ContactSides<2>::Nodes& nodes = loop.nodes[g];
    const ContactSides<2>::Bounds& bounds = loop.bounds[g];
    for (std::size_t k = 0; k < lanes; k += width, own_records += 4 * width) {
      const Columns<width> own = columns_at<width>(own_records);
      V stiffness{}, stiffness_roll{};
      for (std::size_t row = rows.first; row < rows.first + rows.count; ++row) {
        const ContactSides<2>::Start& start = loop.starts[row];
        ContactSides<2>::Side& side = loop.sides[row];
        const Columns<width> other = records_of<width>(loop.records, side.other + k);
        const V x = own.x - other.x + load<width>(start.offset_x + k);
        const V y = own.y - other.y + load<width>(start.offset_y + k);
        const V distance = square_root(x * x + y * y + disc_loops::tiny);
        const V inverse = 1 / distance;
        const V overlap = own.last + other.last - distance;
        const auto here = overlap > zero;
        const V kn = load<width>(side.normal_stiffness + k);
        const V fn = kn * overlap;
        store(side.normal_x + k, x * inverse);
        store(side.normal_y + k, y * inverse);
        store(side.normal_force + k, fn);
        const V start_x = load<width>(start.x + k);
        const V start_y = load<width>(start.y + k);
        const V dot = start_x * x + start_y * y;
        const V cross = start_x * y - start_y * x;
        const V sine = cross * inverse;
        const V excess = dot > zero ? magnitude(sine) - short_series : one;
        beyond = largest(beyond, here ? excess : zero);
        V slip = distance;
        if constexpr (far) {
          slip *= far_turn(distance, dot, cross);
        } else {
          slip *= arc_sine(sine);
        }
        const V kt = ratio * kn;
        if constexpr (rotating) {
          const V stretch = distance * load<width>(start.inverse_reach + k);
          slip += stretch * (load<width>(start.roll + k) - (own.roll + other.roll));
          store(side.stretch + k, stretch);
          stiffness_roll += here ? kt * distance * stretch : zero;
        }
        store(side.trial + k, load<width>(start.force + k) - kt * slip);
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
        put_mass(stiffness_roll * load<width>(bounds.inverse_radius + k), bounds.least_roll,
                 nodes.mass_roll, nodes.gain_roll);
      }
    }
  }
  return {most(beyond), force.total(), touching.total()};
}

template <std::size_t width, bool rotating, bool dragged>
GRAINLAW_INLINE ContactSides<2>::Measured step_loop(const Loop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const double friction = loop.friction;
  const double ratio = loop.ratio;
  const double curvature = loop.curvature;
  V largest_force{};
  GroupSum<width> power, next_power, inertia;
  double* last_moves = loop.last_moves;
  const double* own_records = loop.records;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const SideSlots::Rows rows = loop.groups[g];
    const ContactSides<2>::Nodes& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes;
         k += width, last_moves += 4 * width, own_records += 4 * width) {
      Columns<width> own = columns_at<width>(own_records);
      V x{}, y{}, roll{};
      const ContactSides<2>::Side* side = loop.sides + rows.first;
      for (const auto* const end = side + rows.count; side != end; ++side) {
        const Columns<width> other = records_of<width>(loop.records, side->other + k);
        const V ux = own.x - other.x;
        const V uy = own.y - other.y;
        const V nx = load<width>(side->normal_x + k);
        const V ny = load<width>(side->normal_y + k);
        const V kn = load<width>(side->normal_stiffness + k);
        const V fn = largest(load<width>(side->normal_force + k) - kn * (nx * ux + ny * uy), zero);
        const V across = nx * uy - ny * ux;
        const V turn = curvature * across;
        const V ax = nx - turn * ny;
        const V ay = ny + turn * nx;
        V slip = across;
        V stretch{};
        if constexpr (rotating) {
          stretch = load<width>(side->stretch + k);
          slip -= stretch * (own.roll + other.roll);
        }
        const V trial = load<width>(side->trial + k) - ratio * kn * slip;
        const V bound = friction * fn;
        const V ft = smallest(largest(trial, -bound), bound);
        x += fn * ax - ft * ay;
        y += fn * ay + ft * ax;
        if constexpr (rotating) roll -= stretch * ft;
      }
      if constexpr (dragged) {
        const ContactSides<2>::Drag& drag = loop.drags[g];
        const V stiffness = load<width>(drag.stiffness + k);
        x += stiffness * (load<width>(drag.x + k) - own.x);
        y += stiffness * (load<width>(drag.y + k) - own.y);
        if constexpr (rotating) {
          roll += load<width>(drag.stiffness_roll + k) * (load<width>(drag.roll + k) - own.roll);
        }
      }
      V work{}, next_work{}, twice_energy{};
      const Columns<width> last = columns_at<width>(last_moves);
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
      if constexpr (rotating) go_on(roll, nodes.mass_roll, nodes.gain_roll, last.roll, own.roll);
      power.add(k, work);
      next_power.add(k, next_work);
      inertia.add(k, twice_energy);
      put_records<width>(own, last_moves);
    }
  }
  return {most(largest_force), power.total(), next_power.total(), inertia.total()};
}

}  // namespace grainlaw::core::disc_sides

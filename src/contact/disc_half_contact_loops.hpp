// Loops over half contacts of discs, node by node: a relinearisation, and a step of a relaxation to
// first order around it, in double or single precision.
#pragma once

#include "contact/disc_loops.hpp"
#include "contact/float_columns.hpp"
#include "contact/half_contact_steps.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>

namespace grainlaw::core::disc_half_contacts {

using namespace half_contact_steps;
using disc_loops::Columns;
using disc_loops::columns_at;
using disc_loops::records_of;
using Half = HalfContactColumns<2>;
constexpr std::size_t lanes = Half::lanes;
static_assert(lanes == ContactList<2>::group);

template <class Real>
struct Relinearisation {
  std::span<const HalfContactRows> groups;
  const Half::Bounds* bounds;
  const Half::Start* starts;
  const double* positions;  // records
  Half::NodesOf<Real>* nodes;
  Half::HalfContactOf<Real>* half_contacts;
  double ratio, factor;
  double per_stiffness, per_force;  // 1 / units of the steps
};

struct Relinearised {
  double beyond;  // > 0: a touching branch rotated beyond the short series
  double force, touching;
};

template <std::size_t width, bool rotating, bool far, class Real>
GRAINLAW_INLINE Relinearised relinearise_loop(const Relinearisation<Real>& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  const double ratio = loop.ratio;
  V beyond{};
  GroupSum<width> force, touching;
  const double* own_records = loop.positions;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactRows rows = loop.groups[g];
    Half::NodesOf<Real>& nodes = loop.nodes[g];
    const Half::Bounds& bounds = loop.bounds[g];
    for (std::size_t k = 0; k < lanes; k += width, own_records += 4 * width) {
      const Columns<width> own = columns_at<width>(own_records);
      V stiffness{}, stiffness_roll{};
      for (std::size_t row = rows.first; row < rows.first + rows.count; ++row) {
        const Half::Start& start = loop.starts[row];
        Half::HalfContactOf<Real>& half = loop.half_contacts[row];
        std::copy_n(start.other + k, width, half.other + k);
        const Columns<width> other = records_of<width>(loop.positions, start.other + k);
        const V x = own.x - other.x + load<width>(start.offset[0] + k);
        const V y = own.y - other.y + load<width>(start.offset[1] + k);
        const V distance = square_root(x * x + y * y + disc_loops::tiny);
        const V inverse = 1 / distance;
        const V overlap = own.last + other.last - distance;
        const auto here = overlap > zero;
        const V kn = load<width>(start.normal_stiffness + k);
        const V fn = kn * overlap;
        put_as<Real, width>(x * inverse, 1, half.normal[0] + k);
        put_as<Real, width>(y * inverse, 1, half.normal[1] + k);
        put_as<Real, width>(kn, loop.per_stiffness, half.normal_stiffness + k);
        put_as<Real, width>(fn, loop.per_force, half.normal_force + k);
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
          put_as<Real, width>(stretch, 1, half.stretch + k);
          stiffness_roll += here ? kt * distance * stretch : zero;
        }
        put_as<Real, width>(load<width>(start.force[0] + k) - kt * slip, loop.per_force,
                            half.trial[0] + k);
        stiffness += here ? kn : zero;
        force.add(k, here ? fn : zero);
        touching.add(k, here ? one : zero);
      }
      put_mass<Real, width>(stiffness, bounds.least + k, loop.factor, loop.per_stiffness,
                            nodes.mass + k, nodes.gain + k);
      if constexpr (rotating) {
        put_mass<Real, width>(stiffness_roll * load<width>(bounds.inverse_radius + k),
                              bounds.least_spin + k, loop.factor, loop.per_stiffness,
                              nodes.mass_spin + k, nodes.gain_spin + k);
      }
    }
  }
  return {most(beyond), force.total(), touching.total()};
}

// Displacement of a node along x and y, and its turn.
template <std::size_t width, class Real>
struct Moved {
  Lanes<width, Real> x, y, roll;
};

template <std::size_t width, class Real>
GRAINLAW_INLINE Moved<width, Real> displacements_at(const Real* records,
                                                    const std::int32_t* index) {
  if constexpr (std::is_same_v<Real, double>) {
    const auto at = records_of<width>(records, index);
    return {at.x, at.y, at.roll};
  } else {
    Lanes<width, float> row[4];
    float_loops::gather_four<width>(records, index, row);
    return {row[0], row[1], row[2]};
  }
}
template <std::size_t width, class Real>
GRAINLAW_INLINE void put_displacements(const Moved<width, Real>& moved, Real* to) {
  if constexpr (std::is_same_v<Real, double>) {
    disc_loops::put_records<width>({moved.x, moved.y, moved.roll, Lanes<width>{}}, to);
  } else {
    const Lanes<width, float> column[4] = {moved.x, moved.y, moved.roll, Lanes<width, float>{}};
    float_loops::scatter_four<width>(column, to);
  }
}

template <std::size_t doubles, bool rotating, bool dragged, class Real>
GRAINLAW_INLINE StepMeasures step_loop(const Step<2, Real>& loop) {
  constexpr std::size_t width = nodes_at_once<2, Real, doubles>;
  using V = Lanes<width, Real>;
  const V zero{};
  NodeSteps<2, width, Real> steps(loop);
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactRows rows = loop.groups[g];
    Half::NodesOf<Real>& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes; k += width) {
      Moved<width, Real> own{load<width>(nodes.moved[0] + k), load<width>(nodes.moved[1] + k),
                             load<width>(nodes.moved[2] + k)};
      V x{}, y{}, roll{};
      const auto* half = loop.half_contacts + rows.first;
      for (const auto* const end = half + rows.count; half != end; ++half) {
        const auto other = displacements_at<width, Real>(loop.displacements, half->other + k);
        const V ux = own.x - other.x;
        const V uy = own.y - other.y;
        const V nx = load<width>(half->normal[0] + k);
        const V ny = load<width>(half->normal[1] + k);
        const V kn = load<width>(half->normal_stiffness + k);
        const V fn = largest(load<width>(half->normal_force + k) - kn * (nx * ux + ny * uy), zero);
        const V across = nx * uy - ny * ux;
        const V skew = loop.curvature * across;
        const V ax = nx - skew * ny;
        const V ay = ny + skew * nx;
        V slip = across;
        V stretch{};
        if constexpr (rotating) {
          stretch = load<width>(half->stretch + k);
          slip -= stretch * (own.roll + other.roll);
        }
        const V trial = load<width>(half->trial[0] + k) - loop.ratio * kn * slip;
        const V bound = loop.friction * fn;
        const V ft = smallest(largest(trial, -bound), bound);
        x += fn * ax - ft * ay;
        y += fn * ay + ft * ax;
        if constexpr (rotating) roll -= stretch * ft;
      }
      if constexpr (dragged) {
        const Half::DragOf<Real>& drag = loop.drags[g];
        const V stiffness = load<width>(drag.stiffness + k);
        x += stiffness * (load<width>(drag.distance[0] + k) - own.x);
        y += stiffness * (load<width>(drag.distance[1] + k) - own.y);
        if constexpr (rotating) {
          roll +=
              load<width>(drag.stiffness_spin + k) * (load<width>(drag.distance[2] + k) - own.roll);
        }
      }
      steps.go_on(nodes, k, 0, false, x, own.x);
      steps.go_on(nodes, k, 1, false, y, own.y);
      if constexpr (rotating) steps.go_on(nodes, k, 2, true, roll, own.roll);
      steps.end(k);
      put_displacements<width, Real>(own, loop.next_displacements + 4 * (lanes * g + k));
    }
  }
  return steps.measured();
}

}  // namespace grainlaw::core::disc_half_contacts

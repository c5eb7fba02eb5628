// Loops over half contacts of spheres, node by node: a relinearisation, and a step of a relaxation
// to first order around it, in double or single precision.
#pragma once

#include "contact/float_columns.hpp"
#include "contact/half_contact_steps.hpp"
#include "contact/sphere_loops.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace grainlaw::core::sphere_half_contacts {

using namespace sphere_loops;
using namespace half_contact_steps;
using half_contact_steps::put_as;
using Half = HalfContactColumns<3>;
constexpr std::size_t lanes = Half::lanes;
static_assert(lanes % ContactList<3>::group == 0);

template <class Real>
struct Relinearisation {
  std::span<const HalfContactRows> groups;
  const Half::Bounds* bounds;
  const Half::Start* starts;
  const double* positions;
  Half::NodesOf<Real>* nodes;
  Half::HalfContactOf<Real>* half_contacts;
  HalfContactRows* near_rows;  // out
  double ratio, factor;
  double margin;                    // gap of near contacts [m]
  double per_stiffness, per_force;  // 1 / units of the steps
};

struct Relinearised {
  double force, touching;
};

template <std::size_t width, class Real>
GRAINLAW_INLINE Triple<width, Real> triple_at(const Half::Lanes<Real>* columns, std::size_t k) {
  return {load<width>(columns[0] + k), load<width>(columns[1] + k), load<width>(columns[2] + k)};
}

template <class Real, std::size_t width>
GRAINLAW_INLINE void put_as(const Triple<width>& value, double per_unit, Half::Lanes<Real>* columns,
                            std::size_t k) {
  put_as<Real, width>(value.x, per_unit, columns[0] + k);
  put_as<Real, width>(value.y, per_unit, columns[1] + k);
  put_as<Real, width>(value.z, per_unit, columns[2] + k);
}

template <std::size_t width, bool rotating, class Real>
GRAINLAW_INLINE Relinearised relinearise_loop(const Relinearisation<Real>& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  GroupSum<width> force, touching;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactRows rows = loop.groups[g];
    const Half::Bounds& bounds = loop.bounds[g];
    Half::NodesOf<Real>& nodes = loop.nodes[g];
    double near = 0;
    for (std::size_t k = 0; k < lanes; k += width) {
      std::int32_t own_index[width];
      for (std::size_t l = 0; l < width; ++l) {
        own_index[l] = static_cast<std::int32_t>(lanes * g + k + l);
      }
      Geometry<width> at;
      at.j = spheres_at<width>(loop.positions, own_index);
      V stiffness{}, stiffness_spin{}, last_near{};
      for (std::uint32_t row = 0; row < rows.count; ++row) {
        const Half::Start& start = loop.starts[rows.first + row];
        Half::HalfContactOf<Real>& half = loop.half_contacts[rows.first + row];
        std::copy_n(start.other + k, width, half.other + k);
        at.i = spheres_at<width>(loop.positions, start.other + k);
        at.branch = sum(sum(at.j.position, -one, at.i.position), triple_at<width>(start.offset, k));
        at.square = dot(at.branch, at.branch) + tiny;
        at.distance = square_root(at.square);
        at.normal = product(1 / at.distance, at.branch);
        at.overlap = at.i.radius + at.j.radius - at.distance;
        const auto here = at.overlap > zero;
        last_near = at.overlap > zero - loop.margin ? zero + (row + 1.0) : last_near;
        const V kn = load<width>(start.normal_stiffness + k);
        const V fn = kn * at.overlap;
        const V kt = loop.ratio * kn;
        Triple<width> h = sum(triple_at<width>(start.force, k), kt * at.distance,
                              triple_at<width>(start.normal, k));
        if constexpr (rotating) h = rotated(at, h);
        const V stretch = at.distance * load<width>(start.inverse_reach + k);
        put_as<Real>(at.normal, 1, half.normal, k);
        put_as<Real, width>(kn, loop.per_stiffness, half.normal_stiffness + k);
        put_as<Real, width>(fn, loop.per_force, half.normal_force + k);
        put_as<Real>(sum(h, -dot(at.normal, h), at.normal), loop.per_force, half.trial, k);
        put_as<Real, width>(stretch, 1, half.stretch + k);
        stiffness += here ? kn : zero;
        stiffness_spin += here ? kt * at.distance * stretch : zero;
        force.add(k, here ? fn : zero);
        touching.add(k, here ? one : zero);
      }
      near = std::max(near, most(last_near));
      put_mass<Real, width>(stiffness, bounds.least + k, loop.factor, loop.per_stiffness,
                            nodes.mass + k, nodes.gain + k);
      if constexpr (rotating) {
        put_mass<Real, width>(stiffness_spin * load<width>(bounds.inverse_radius + k),
                              bounds.least_spin + k, loop.factor, loop.per_stiffness,
                              nodes.mass_spin + k, nodes.gain_spin + k);
      }
    }
    loop.near_rows[g] = {rows.first, static_cast<std::uint32_t>(near)};
  }
  return {force.total(), touching.total()};
}

// Displacements of the nodes at these indices.
template <std::size_t width, class Real>
GRAINLAW_INLINE void displacements_at(const Real* records, const std::int32_t* index,
                                      Triple<width, Real>& moved, Triple<width, Real>& spin) {
  if constexpr (std::is_same_v<Real, double>) {
    const auto first = disc_loops::records_of<width, 8>(records, index);
    const auto second = disc_loops::records_of<width, 8>(records + 4, index);
    moved = {first.x, first.y, first.roll};
    spin = {first.last, second.x, second.y};
  } else {
    Lanes<width, float> column[6];
    float_loops::gather<width>(records, index, column);
    moved = {column[0], column[1], column[2]};
    spin = {column[3], column[4], column[5]};
  }
}
template <std::size_t width, class Real>
GRAINLAW_INLINE void put_displacements(const Triple<width, Real>& moved,
                                       const Triple<width, Real>& spin, Real* to) {
  if constexpr (std::is_same_v<Real, double>) {
    put_records(moved, spin, to);
  } else {
    const Lanes<width, float> column[6] = {moved.x, moved.y, moved.z, spin.x, spin.y, spin.z};
    float_loops::scatter<width>(column, to);
  }
}

template <std::size_t doubles, bool rotating, bool dragged, class Real>
GRAINLAW_INLINE StepMeasures step_loop(const Step<3, Real>& loop) {
  constexpr std::size_t width = nodes_at_once<3, Real, doubles>;
  // Below it a squared trial force is nothing, in units of the steps.
  constexpr Real least_square = std::is_same_v<Real, double> ? Real(tiny) : Real(1e-30);
  using V = Lanes<width, Real>;
  using T = Triple<width, Real>;
  const V zero{};
  const V one = zero + Real(1);
  NodeSteps<3, width, Real> steps(loop);
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const HalfContactRows rows = loop.groups[g];
    Half::NodesOf<Real>& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes; k += width) {
      T own = triple_at<width, Real>(nodes.moved, k);
      T own_spin = triple_at<width, Real>(nodes.moved + 3, k);
      T f{zero, zero, zero};
      T tau{zero, zero, zero};
      const auto* half = loop.half_contacts + rows.first;
      for (const auto* const end = half + rows.count; half != end; ++half) {
        T moved, spin;
        displacements_at<width, Real>(loop.displacements, half->other + k, moved, spin);
        const T u = sum(own, -one, moved);
        const T n = triple_at<width, Real>(half->normal, k);
        const V kn = load<width>(half->normal_stiffness + k);
        const V kt = loop.ratio * kn;
        const V along = dot(n, u);
        const V fn = largest(load<width>(half->normal_force + k) - kn * along, zero);
        T slip = sum(u, -along, n);
        V stretch{};
        if constexpr (rotating) {
          stretch = load<width>(half->stretch + k);
          slip = sum(slip, -stretch, cross(sum(own_spin, spin), n));
        }
        const T trial = sum(triple_at<width, Real>(half->trial, k), -kt, slip);
        const V bound = loop.friction * fn;
        const V size = square_root(dot(trial, trial) + least_square);
        const T ft = product(smallest(bound / size, one), trial);
        f = sum(f, sum(ft, fn, n));
        if constexpr (rotating) tau = sum(tau, -stretch, cross(n, ft));
      }
      if constexpr (dragged) {
        const Half::DragOf<Real>& drag = loop.drags[g];
        const auto pull = [&](const Real* stiffness, const Half::Lanes<Real>* distance,
                              const T& moved, T& force) {
          const T left = sum(triple_at<width, Real>(distance, k), -one, moved);
          force = sum(force, load<width>(stiffness + k), left);
        };
        pull(drag.stiffness, drag.distance, own, f);
        if constexpr (rotating) pull(drag.stiffness_spin, drag.distance + 3, own_spin, tau);
      }
      steps.go_on(nodes, k, 0, false, f.x, own.x);
      steps.go_on(nodes, k, 1, false, f.y, own.y);
      steps.go_on(nodes, k, 2, false, f.z, own.z);
      if constexpr (rotating) {
        steps.go_on(nodes, k, 3, true, tau.x, own_spin.x);
        steps.go_on(nodes, k, 4, true, tau.y, own_spin.y);
        steps.go_on(nodes, k, 5, true, tau.z, own_spin.z);
      }
      steps.end(k);
      put_displacements<width, Real>(own, own_spin, loop.next_displacements + 8 * (lanes * g + k));
    }
  }
  return steps.measured();
}

}  // namespace grainlaw::core::sphere_half_contacts

// Loops over all contacts of spheres: one template over the features of a law.
//   h = Rbar (ft_c + kt d n_c);  t* = h - n (n.h);  ft = t* min(1, friction fn / |t*|).
// Rbar is the mean rotation of the pair, weighted by the radii. One formula contains the spring,
// its rotation with the contact, and the increment of slip. It is exact for rigid rotations of the
// pair and agrees with discs in the plane to second order. @formula mean-rotation
#pragma once

#include "contact/contact_forces.hpp"
#include "contact/sphere_columns.hpp"

#include <cstddef>
#include <limits>

namespace grainlaw::core::sphere_loops {

struct Loop {
  const ParticleRecord<3>* particles;
  double friction;
  ContactList<3>* list;
};

// Features of a law; a loop contains only the features of its law.
struct Features {
  bool tangential = true;
  bool rotating = true;
  bool hertz = false;
  bool bonds = false;
  bool moments = false;
};

constexpr double tiny = std::numeric_limits<double>::min();
constexpr double hertz_share = 2.0 / 3;  // fn / (kn overlap)

template <std::size_t width>
struct Geometry {
  Triple<width> branch, normal;
  Lanes<width> square, distance, overlap;
  Spheres<width> i, j;
};

template <std::size_t width, Features law>
GRAINLAW_INLINE Geometry<width> geometry_of(const Loop& loop, std::size_t c) {
  const ContactList<3>& list = *loop.list;
  const double* records = &loop.particles->x;
  Geometry<width> at;
  at.i = spheres_at<width>(records, &list.i[c]);
  at.j = spheres_at<width>(records, &list.j[c]);
  const Lanes<width> one = Lanes<width>{} + 1.0;
  at.branch = sum(sum(at.j.position, -one, at.i.position), triple_at<width>(list.offset, c));
  at.square = dot(at.branch, at.branch) + tiny;
  at.distance = square_root(at.square);
  at.normal = product(1 / at.distance, at.branch);
  if constexpr (law.bonds) {
    at.overlap = load<width>(&list.rest[c]) - at.distance;
  } else {
    at.overlap = at.i.radius + at.j.radius - at.distance;
  }
  return at;
}

// Rbar g, with the mean quaternion (w, v) of the pair, not normalised.
template <std::size_t width>
GRAINLAW_INLINE Triple<width> rotated(const Geometry<width>& at, const Triple<width>& g) {
  const Lanes<width> w = 2 * (at.i.half * at.i.radius + at.j.half * at.j.radius);
  const Triple<width> v = sum(product(at.i.half, at.i.eta), at.j.half, at.j.eta);
  const Triple<width> u = sum(product(w, g), cross(v, g));
  return sum(g, 2 / (w * w + dot(v, v)), cross(v, u));
}

// Energy lost by a spring of this stiffness [J]. `start`: its force there; `size`: its trial
// force; `carried`: its force within the bound.
template <std::size_t width>
GRAINLAW_INLINE Lanes<width> lost_by(const Lanes<width>& start, const Lanes<width>& size,
                                     const Lanes<width>& carried, const Lanes<width>& bound,
                                     const Lanes<width>& stiffness) {
  const Lanes<width> zero{};
  const Lanes<width> excess = largest(start - bound, zero);
  const Lanes<width> lost = (carried * (size - carried) + 0.5 * excess * excess) / stiffness;
  return stiffness > zero ? lost : zero;
}

// Finds the moment on j and returns the lost energy [J]; advancing restarts the history from it.
// With rho = 2 vec q_j conj(q_i): m* = Rbar m_c - kb rho_across - kr rho_along, across and along n.
// Each part is limited to its bound.
template <std::size_t width, Features law, bool advance>
GRAINLAW_INLINE Lanes<width> moment_of(const Loop& loop, std::size_t c, const Geometry<width>& at,
                                       const Lanes<width>& fn, const Lanes<width>& root,
                                       const Lanes<width>& fourth) {
  using V = Lanes<width>;
  ContactList<3>& list = *loop.list;
  const V zero{};
  V bending = load<width>(&list.bending_stiffness[c]);
  V torsion = load<width>(&list.torsion_stiffness[c]);
  Triple<width> start = triple_at<width>(list.start_moment, c);
  if constexpr (law.hertz) {
    bending *= root;
    torsion *= root;
    start = product(fourth, start);
  }
  const Triple<width> a = product(at.i.half / at.i.radius, at.i.eta);
  const Triple<width> b = product(at.j.half / at.j.radius, at.j.eta);
  const Triple<width> relative =
      sum(sum(product(2 * at.i.half, b), -2 * at.j.half, a), cross(a, b));
  const V along = 2 * dot(at.normal, relative);
  const Triple<width> sprung = rotated(at, start);
  Triple<width> trial = sum(sprung, -2 * bending, relative);
  trial = sum(trial, (bending - torsion) * along, at.normal);
  const V twist = dot(at.normal, trial);
  const Triple<width> roll = sum(trial, -twist, at.normal);
  V roll_bound = load<width>(&list.rolling_length[c]) * fn;
  V twist_bound = load<width>(&list.twisting_length[c]) * fn;
  if constexpr (law.bonds) {
    const V capacity = load<width>(&list.bond_capacity[c]);
    roll_bound = largest(roll_bound, capacity);
    twist_bound = largest(twist_bound, capacity);
  }
  const V size = square_root(dot(roll, roll) + tiny);
  const V carried = smallest(size, roll_bound);
  const V carried_twist = largest(smallest(twist, twist_bound), -twist_bound);
  const Triple<width> moment = sum(product(carried / size, roll), carried_twist, at.normal);
  put_records(moment, {zero, zero, zero}, &list.moments[c].x);
  if constexpr (!advance) return zero;
  const V start_twist = dot(at.normal, sprung);
  const Triple<width> start_roll = sum(sprung, -start_twist, at.normal);
  V lost =
      lost_by<width>(square_root(dot(start_roll, start_roll)), size, carried, roll_bound, bending) +
      lost_by<width>(magnitude(start_twist), magnitude(twist), magnitude(carried_twist),
                     twist_bound, torsion);
  if constexpr (law.hertz) {
    put(product(root > zero ? 1 / fourth : zero, moment), list.start_moment, c);
  } else {
    put(moment, list.start_moment, c);
  }
  return lost;
}

template <std::size_t width, Features law, bool advance>
GRAINLAW_INLINE double contact_loop(const Loop& loop) {
  using V = Lanes<width>;
  ContactList<3>& list = *loop.list;
  const V zero{};
  GroupSum<width> dissipated;
  for (std::size_t c = 0; c < list.i.size(); c += width) {
    const Geometry<width> at = geometry_of<width, law>(loop, c);
    V depth = largest(at.overlap, zero);
    if constexpr (law.bonds)
      depth = load<width>(&list.bond_capacity[c]) > zero ? at.overlap : depth;
    V fn = load<width>(&list.normal_stiffness[c]) * depth;
    V root{}, fourth{};
    if constexpr (law.hertz) {
      root = square_root(depth);
      fourth = square_root(root);
      fn *= hertz_share * root;
    }
    Triple<width> force = product(fn, at.normal);
    Triple<width> spin{zero, zero, zero};
    if constexpr (law.tangential) {
      V kt = load<width>(&list.tangential_stiffness[c]);
      Triple<width> start = triple_at<width>(list.start_force, c);
      if constexpr (law.hertz) {
        kt *= root;
        start = product(fourth, start);
      }
      Triple<width> h = sum(start, kt * at.distance, triple_at<width>(list.start_normal, c));
      if constexpr (law.rotating) h = rotated(at, h);
      const Triple<width> trial = sum(h, -dot(at.normal, h), at.normal);
      const V size = square_root(dot(trial, trial) + tiny);
      V bound = loop.friction * fn;
      if constexpr (law.bonds) bound = largest(bound, load<width>(&list.bond_capacity[c]));
      const V carried = smallest(size, bound);
      const Triple<width> ft = product(carried / size, trial);
      force = sum(force, ft);
      if constexpr (law.rotating) {
        spin = product(-load<width>(&list.inverse_reach[c]), cross(at.branch, ft));
      }
      if constexpr (advance) {
        const V lost = lost_by<width>(square_root(dot(start, start)), size, carried, bound, kt);
        put(at.normal, list.start_normal, c);
        if constexpr (law.hertz) {
          // An open contact loses the whole energy of its spring.
          const Triple<width> kept = triple_at<width>(list.start_force, c);
          const V all = load<width>(&list.tangential_stiffness[c]);
          dissipated.add(c, kt > zero ? lost : (all > zero ? 0.5 * dot(kept, kept) / all : zero));
          put(product(kt > zero ? 1 / fourth : zero, ft), list.start_force, c);
        } else {
          dissipated.add(c, lost);
          put(ft, list.start_force, c);
        }
      }
    }
    put_records(force, spin, &list.forces[c].x);
    if constexpr (law.moments) {
      const V lost = moment_of<width, law, advance>(loop, c, at, fn, root, fourth);
      if constexpr (advance) dissipated.add(c, lost);
    }
  }
  return dissipated.total();
}

// Writes records of the touching contacts: three times kn, three times kt d^2 / (R_i + R_j), and
// the larger of kb and kr.
template <std::size_t width, Features law>
GRAINLAW_INLINE ContactTotals stiffness_loop(const Loop& loop) {
  using V = Lanes<width>;
  ContactList<3>& list = *loop.list;
  const V zero{};
  const V one = zero + 1.0;
  GroupSum<width> force, touching;
  for (std::size_t c = 0; c < list.i.size(); c += width) {
    const Geometry<width> at = geometry_of<width, law>(loop, c);
    V overlap = at.overlap;
    if constexpr (law.bonds) {
      overlap = load<width>(&list.bond_capacity[c]) > zero ? magnitude(overlap) + tiny : overlap;
    }
    const auto here = overlap > zero;
    V kn = here ? load<width>(&list.normal_stiffness[c]) : zero;
    V kt = here ? load<width>(&list.tangential_stiffness[c]) : zero;
    V share = one;
    if constexpr (law.hertz) {
      const V root = square_root(largest(overlap, zero));
      kn *= root;
      kt *= root;
      share *= hertz_share;
    }
    force.add(c, share * kn * overlap);
    touching.add(c, here ? one : zero);
    const V spin = kt * at.square * load<width>(&list.inverse_reach[c]);
    V rotational = zero;
    if constexpr (law.moments) {
      rotational =
          largest(load<width>(&list.bending_stiffness[c]), load<width>(&list.torsion_stiffness[c]));
      if constexpr (law.hertz) rotational *= square_root(largest(overlap, zero));
      rotational = here ? rotational : zero;
    }
    put_records<width>({kn, kn, kn}, {spin, spin, spin}, &list.stiffness[c].x, rotational);
  }
  return {force.total(), touching.total(), static_cast<int>(touching.total())};
}

#define GRAINLAW_SPHERE_LOOP(Result, name, loop_of, ...) \
  GRAINLAW_BY_LANES(Result, name, loop_of, (const Loop& loop), (loop)__VA_OPT__(, ) __VA_ARGS__)

}  // namespace grainlaw::core::sphere_loops

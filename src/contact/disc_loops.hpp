// Loops over all contacts: one template over the features of a law, for two, four and eight lanes.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_list.hpp"
#include "contact/disc_columns.hpp"
#include "contact/disc_rotation.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace grainlaw::core::disc_loops {

using namespace simd;

constexpr double tiny = std::numeric_limits<double>::min();
constexpr double hertz_share = 2.0 / 3;  // fn / (kn overlap)

struct Loop {
  const ParticleRecord<2>* particles;
  double friction;
  ContactList<2>* list;
};

// Intermediate values of a block of contacts. Loops pass over a block in steps with short
// dependency chains, so that the processor finds independent operations.
constexpr std::size_t block = 4 * ContactList<2>::group;
struct alignas(64) Block {
  double x[block], y[block];  // branch [m]
  double reach[block];        // R_i + R_j [m]
  double roll[block];         // R_i theta_i + R_j theta_j [m]
  double distance[block], inverse[block], sine[block], normal_force[block];
  double root[block];  // square root of the overlap, Hertz-Mindlin alone [m^0.5]
};

// Finds the branches: subtracts the particles' records and transposes them. @formula branch
template <std::size_t width>
GRAINLAW_INLINE void find_branches(const double* particles, const ContactList<2>& list,
                                   std::size_t first, std::size_t size, Block& at) {
  const double* offset_x = list.offset[0].data() + first;
  const double* offset_y = list.offset[1].data() + first;
  for (std::size_t c = 0; c < size; c += width) {
    const Columns<width> pair =
        pair_columns<width>(particles, &list.i[first + c], &list.j[first + c]);
    store(at.x + c, pair.x + load<width>(offset_x + c));
    store(at.y + c, pair.y + load<width>(offset_y + c));
    store(at.roll + c, pair.roll);
    store(at.reach + c, pair.last);
  }
}

enum class Kinematics { frictionless, locked, rotating };

// Features of a law; a loop contains only the features of its law.
struct Features {
  Kinematics kinematics;
  bool hertz = false;
  bool bonds = false;
  bool moments = false;
};

struct LoopResult {
  double beyond;      // > 0: a touching branch rotated beyond the short series
  double dissipated;  // when advancing [J]
};

// Overlap of contacts [m], negative across a gap.
template <std::size_t width, Features law>
GRAINLAW_INLINE Lanes<width> overlap_of(const ContactList<2>& list, std::size_t c,
                                        const Lanes<width>& reach, const Lanes<width>& distance) {
  if constexpr (law.bonds) {
    return load<width>(&list.rest[c]) - distance;
  } else {
    return reach - distance;
  }
}
// Least overlap at which contacts transmit force [m].
template <std::size_t width, Features law>
GRAINLAW_INLINE Lanes<width> least_overlap(const ContactList<2>& list, std::size_t c) {
  if constexpr (law.bonds) {
    return -load<width>(&list.bond_capacity[c]);
  } else {
    return Lanes<width>{};
  }
}

// Relative rotation theta_j - theta_i [rad].
template <std::size_t width>
GRAINLAW_INLINE Lanes<width> spin_of(const ParticleRecord<2>* particles, const ContactList<2>& list,
                                     std::size_t c) {
  Lanes<width> roll_i, roll_j;
  for (std::size_t k = 0; k < width; ++k) {
    roll_i[k] = particles[static_cast<std::size_t>(list.i[c + k])].roll;
    roll_j[k] = particles[static_cast<std::size_t>(list.j[c + k])].roll;
  }
  return roll_j * load<width>(&list.inverse_radius_j[c]) -
         roll_i * load<width>(&list.inverse_radius_i[c]);
}

// Finds normal forces and the sine of the branch's rotation since the start of the increment.
// Returns by how much a touching branch exceeds the short series.
template <std::size_t width, Features law>
GRAINLAW_INLINE Lanes<width> find_normals(const ContactList<2>& list, std::size_t first,
                                          std::size_t size, Block& at) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  V beyond{};
  const double* kn = list.normal_stiffness.data() + first;
  const double* start_x = list.start_normal[0].data() + first;
  const double* start_y = list.start_normal[1].data() + first;
  for (std::size_t c = 0; c < size; c += width) {
    const V x = load<width>(at.x + c);
    const V y = load<width>(at.y + c);
    const V nx = load<width>(start_x + c);
    const V ny = load<width>(start_y + c);
    const V square = x * x + y * y + tiny;
    const V distance = square_root(square);
    const V overlap = overlap_of<width, law>(list, first + c, load<width>(at.reach + c), distance);
    const V least = least_overlap<width, law>(list, first + c);
    const V inverse = 1 / distance;
    const V dot = nx * x + ny * y;
    const V sine = (nx * y - ny * x) * inverse;
    const V excess = dot > zero ? magnitude(sine) - short_series : one;
    beyond = largest(beyond, overlap > least ? excess : zero);
    store(at.distance + c, distance);
    store(at.inverse + c, inverse);
    store(at.sine + c, sine);
    const V depth = largest(overlap, least);
    if constexpr (law.hertz) {
      const V root = square_root(depth);
      store(at.root + c, root);
      store(at.normal_force + c, hertz_share * load<width>(kn + c) * root * depth);
    } else {
      store(at.normal_force + c, load<width>(kn + c) * depth);
    }
  }
  return beyond;
}

// Energy lost by sliding (rolling) at the force, and by the spring when its bound falls below its
// force [J].
template <std::size_t width>
GRAINLAW_INLINE Lanes<width> lost_by(const Lanes<width>& start, const Lanes<width>& trial,
                                     const Lanes<width>& force, const Lanes<width>& bound,
                                     const Lanes<width>& stiffness) {
  const Lanes<width> excess = largest(magnitude(start) - bound, Lanes<width>{});
  return (magnitude(force * (trial - force)) + 0.5 * excess * excess) / stiffness;
}

// Finds forces. `far` admits any rotation; `advance` restarts the history here and sums the
// dissipated energy.
template <std::size_t width, Features law, bool far, bool advance>
GRAINLAW_INLINE void find_forces(const Loop& loop, std::size_t first, std::size_t size,
                                 const Block& at, GroupSum<width>& dissipated) {
  using V = Lanes<width>;
  constexpr bool rotating = law.kinematics == Kinematics::rotating;
  ContactList<2>& list = *loop.list;
  const V zero{};
  const double* inverse_reach = list.inverse_reach.data() + first;
  const double* stiffness = list.tangential_stiffness.data() + first;
  double* start_x = list.start_normal[0].data() + first;
  double* start_y = list.start_normal[1].data() + first;
  double* start_roll = list.start_roll.data() + first;
  double* start_force = list.start_force[0].data() + first;
  double* forces = &list.forces[first].x;
  for (std::size_t c = 0; c < size; c += width) {
    const V x = load<width>(at.x + c);
    const V y = load<width>(at.y + c);
    const V distance = load<width>(at.distance + c);
    const V inverse = load<width>(at.inverse + c);
    const V fn = load<width>(at.normal_force + c);
    V slip_angle;
    if constexpr (far) {
      const V dot = load<width>(start_x + c) * x + load<width>(start_y + c) * y;
      const V cross = load<width>(start_x + c) * y - load<width>(start_y + c) * x;
      slip_angle = far_angle(distance, dot, cross);
    } else {
      slip_angle = arc_sine(load<width>(at.sine + c));
    }
    V slip = distance * slip_angle;
    const V stretch = distance * load<width>(inverse_reach + c);
    const V roll = load<width>(at.roll + c);
    if constexpr (rotating) slip += stretch * (load<width>(start_roll + c) - roll);
    V kt = load<width>(stiffness + c);
    V start = load<width>(start_force + c);
    V root{}, fourth{};
    if constexpr (law.hertz) {
      root = load<width>(at.root + c);
      fourth = square_root(root);
      kt *= root;
      start *= fourth;
    }
    const V trial = start - kt * slip;
    V bound = loop.friction * fn;
    if constexpr (law.bonds) bound += load<width>(&list.bond_capacity[first + c]);
    const V ft = smallest(largest(trial, -bound), bound);
    V moment{};
    if constexpr (law.moments) {
      const V spin = spin_of<width>(loop.particles, list, first + c);
      V kr = load<width>(&list.bending_stiffness[first + c]);
      V start_moment = load<width>(&list.start_moment[0][first + c]);
      if constexpr (law.hertz) {
        kr *= root;
        start_moment *= fourth;
      }
      const V trial_moment =
          start_moment - kr * (spin - load<width>(&list.start_spin[0][first + c]));
      V largest_moment = load<width>(&list.rolling_length[first + c]) * fn;
      if constexpr (law.bonds) largest_moment += load<width>(&list.bond_capacity[first + c]);
      moment = smallest(largest(trial_moment, -largest_moment), largest_moment);
      if constexpr (advance) {
        const V lost = lost_by<width>(start_moment, trial_moment, moment, largest_moment, kr);
        if constexpr (law.hertz) {
          const V whole = load<width>(&list.start_moment[0][first + c]);
          const V all = load<width>(&list.bending_stiffness[first + c]);
          dissipated.add(c, kr > zero ? lost : (all > zero ? 0.5 * whole * whole / all : zero));
          moment = kr > zero ? moment : zero;
          store(&list.start_moment[0][first + c], kr > zero ? moment / fourth : zero);
        } else {
          dissipated.add(c, kr > zero ? lost : zero);
          store(&list.start_moment[0][first + c], moment);
        }
        store(&list.start_spin[0][first + c], spin);
      }
    }
    put_records<width>({(fn * x - ft * y) * inverse, (fn * y + ft * x) * inverse,
                        rotating ? -stretch * ft : zero, moment},
                       forces + 4 * c);
    if constexpr (advance) {
      const V lost = lost_by<width>(start, trial, ft, bound, kt);
      store(start_x + c, x * inverse);
      store(start_y + c, y * inverse);
      if constexpr (rotating) store(start_roll + c, roll);
      if constexpr (law.hertz) {
        // An open contact loses the whole energy of its spring.
        const V whole = load<width>(start_force + c);
        const V all = load<width>(stiffness + c);
        dissipated.add(c, kt > zero ? lost : (all > zero ? 0.5 * whole * whole / all : zero));
        store(start_force + c, kt > zero ? ft / fourth : zero);
      } else {
        dissipated.add(c, kt > zero ? lost : zero);
        store(start_force + c, ft);
      }
    }
  }
}

template <std::size_t width, Features law, bool far, bool advance>
GRAINLAW_INLINE LoopResult contact_loop(const Loop& loop) {
  using V = Lanes<width>;
  ContactList<2>& list = *loop.list;
  V beyond{};
  GroupSum<width> dissipated;
  Block at;
  for (std::size_t first = 0; first < list.i.size(); first += block) {
    const std::size_t size = std::min(block, list.i.size() - first);
    find_branches<width>(&loop.particles->x, list, first, size, at);
    if constexpr (law.kinematics == Kinematics::frictionless) {
      for (std::size_t c = 0; c < size; c += width) {
        const V x = load<width>(at.x + c);
        const V y = load<width>(at.y + c);
        const V distance = square_root(x * x + y * y + tiny);
        const V overlap = load<width>(at.reach + c) - distance;
        V fn = load<width>(&list.normal_stiffness[first + c]) * largest(overlap, V{});
        if constexpr (law.hertz) fn *= hertz_share * square_root(largest(overlap, V{}));
        const V f = fn / distance;
        put_records<width>({f * x, f * y, V{}, V{}}, &list.forces[first + c].x);
      }
    } else {
      beyond = largest(beyond, find_normals<width, law>(list, first, size, at));
      find_forces<width, law, far, advance>(loop, first, size, at, dissipated);
    }
  }
  return {most(beyond), dissipated.total()};
}

#define GRAINLAW_LOOP(Result, name, loop_of, ...) \
  GRAINLAW_BY_LANES(Result, name, loop_of, (const Loop& loop), (loop)__VA_OPT__(, ) __VA_ARGS__)

}  // namespace grainlaw::core::disc_loops

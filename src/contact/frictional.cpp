#include "contact/frictional.hpp"

#include "simd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

namespace {

using namespace simd;

// The force on i against that on j.
constexpr ForceRecord opposite = {-1, -1, 1, 1};

static_assert(sizeof(ParticleRecord) == sizeof(Record) && sizeof(ForceRecord) == sizeof(Record));

constexpr double tiny = std::numeric_limits<double>::min();
// Up to this tangent the series of an angle is exact to round-off: 11 degrees, more than touching
// contacts usually turn by in an increment of a host's size.
constexpr double short_series = 0.2;

// The arc tangent of t by its series, without a trigonometric call; to round-off for |t| <= 0.2.
// Summed in pairs: one long chain of multiplications would set the pace of the whole loop.
template <class Vector>
GRAINLAW_INLINE Vector arc_tangent(const Vector& t) {
  const Vector u = t * t;
  const Vector u2 = u * u;
  const Vector u4 = u2 * u2;
  const Vector a = (1.0 - u * (1.0 / 3)) + u2 * (1.0 / 5 - u * (1.0 / 7));
  const Vector b = (1.0 / 9 - u * (1.0 / 11)) + u2 * (1.0 / 13 - u * (1.0 / 15));
  const Vector c = (1.0 / 17 - u * (1.0 / 19)) + u2 * (1.0 / 21);
  return t * (a + u4 * (b + u4 * c));
}

struct Loop {
  const ParticleRecord* particles;
  double friction;
  ContactList* list;
};

// The records of four (or twice four) particles, one a row.
template <std::size_t width>
GRAINLAW_INLINE Lanes<width> record(const double* records, const std::int32_t* index,
                                    std::size_t k) {
  const auto at = [&](std::size_t lane) {
    return load<4>(records + 4 * static_cast<std::size_t>(index[lane]));
  };
  if constexpr (width == 4) {
    return at(k);
  } else {
    return beside(at(k), at(k + 4));
  }
}

// What is known of a block of contacts. The loops go over a block in steps, each with short chains of
// operations that depend on each other, so that the processor finds others to do meanwhile.
constexpr std::size_t block = 4 * ContactList::group;
struct alignas(64) Block {
  double x[block], y[block];  // branch [m]
  double reach[block];        // R_i + R_j [m]
  double roll[block];         // R_i theta_i + R_j theta_j [m]
  double distance[block], inverse[block], tangent[block], normal_force[block];
};

// Branches: the particles' records subtracted and transposed.
template <std::size_t width>
GRAINLAW_INLINE void find_branches(const double* particles, const ContactList& list,
                                   std::size_t first, std::size_t size, Block& at) {
  using V = Lanes<width>;
  V sign;  // p_j - sign p_i = (l_x, l_y, rolls, radii)
  for (std::size_t k = 0; k < width; ++k) sign[k] = k % 4 < 2 ? 1 : -1;
  const std::int32_t* i = list.i.data() + first;
  const std::int32_t* j = list.j.data() + first;
  const double* offset_x = list.offset_x.data() + first;
  const double* offset_y = list.offset_y.data() + first;
  for (std::size_t c = 0; c < size; c += width) {
    V a = record<width>(particles, j + c, 0) - sign * record<width>(particles, i + c, 0);
    V b = record<width>(particles, j + c, 1) - sign * record<width>(particles, i + c, 1);
    V e = record<width>(particles, j + c, 2) - sign * record<width>(particles, i + c, 2);
    V d = record<width>(particles, j + c, 3) - sign * record<width>(particles, i + c, 3);
    transpose(a, b, e, d);
    store(at.x + c, a + load<width>(offset_x + c));
    store(at.y + c, b + load<width>(offset_y + c));
    store(at.roll + c, e);
    store(at.reach + c, d);
  }
}

// The columns (x, y, roll, unused) of some contacts as records.
template <std::size_t width>
GRAINLAW_INLINE void put_records(const Lanes<width>& columns_x, const Lanes<width>& columns_y,
                                 const Lanes<width>& columns_roll,
                                 const Lanes<width>& columns_unused, double* to) {
  Lanes<width> x = columns_x;
  Lanes<width> y = columns_y;
  Lanes<width> roll = columns_roll;
  Lanes<width> unused = columns_unused;
  transpose(x, y, roll, unused);
  if constexpr (width == 4) {
    store(to, x);
    store(to + 4, y);
    store(to + 8, roll);
    store(to + 12, unused);
  } else {
    store(to, first(x));
    store(to + 4, first(y));
    store(to + 8, first(roll));
    store(to + 12, first(unused));
    store(to + 16, second(x));
    store(to + 20, second(y));
    store(to + 24, second(roll));
    store(to + 28, second(unused));
  }
}

// A sum over contacts by their places in a group, so that it has the same bits for any width.
template <std::size_t width>
struct GroupSum {
  static constexpr std::size_t parts = ContactList::group / width;
  Lanes<width> part[parts] = {};

  GRAINLAW_INLINE void add(std::size_t c, const Lanes<width>& value) {
    part[c / width % parts] += value;
  }
  GRAINLAW_INLINE double total() const {
    double sum = 0;
    for (const auto& lanes : part) {
      for (std::size_t k = 0; k < width; ++k) sum += lanes[k];
    }
    return sum;
  }
};

enum class Kinematics { frictionless, locked, rotating };

struct LoopResult {
  double beyond;      // > 0: a touching branch turned beyond the short series
  double dissipated;  // when advancing [J]
};

// Normal forces, and the tangent of the turning since the start of the increment. Returns by how
// much a touching branch has turned beyond the short series.
template <std::size_t width>
GRAINLAW_INLINE Lanes<width> find_normals(const ContactList& list, std::size_t first,
                                          std::size_t size, Block& at) {
  using V = Lanes<width>;
  const V zero{};
  V beyond{};
  const double* kn = list.normal_stiffness.data() + first;
  const double* start_x = list.start_x.data() + first;
  const double* start_y = list.start_y.data() + first;
  for (std::size_t c = 0; c < size; c += width) {
    const V x = load<width>(at.x + c);
    const V y = load<width>(at.y + c);
    const V nx = load<width>(start_x + c);
    const V ny = load<width>(start_y + c);
    const V square = x * x + y * y + tiny;
    const V distance = square_root(square);
    const V overlap = load<width>(at.reach + c) - distance;
    const V dot = nx * x + ny * y;
    const V cross = nx * y - ny * x;
    // One division for 1/d and 1/dot, beside the square root, not after it.
    const V ahead = dot > zero ? dot : square;
    const V quotient = 1 / (square * ahead);
    const V excess = magnitude(cross) - short_series * dot;
    beyond = largest(beyond, overlap > zero ? excess : zero);
    store(at.distance + c, distance);
    store(at.inverse + c, distance * (ahead * quotient));
    store(at.tangent + c, cross * (square * quotient));
    store(at.normal_force + c, load<width>(kn + c) * largest(overlap, zero));
  }
  return beyond;
}

// `far` takes any turn by halving the angle, to round-off below 90 degrees and to 1e-7 at 180;
// `advance` moves the start of the history here
// and adds up what was dissipated.
template <std::size_t width, Kinematics kinematics, bool far, bool advance>
GRAINLAW_INLINE void find_forces(double friction, ContactList& list, std::size_t first,
                                 std::size_t size, const Block& at, GroupSum<width>& dissipated) {
  using V = Lanes<width>;
  constexpr bool rotating = kinematics == Kinematics::rotating;
  const V zero{};
  const double* inverse_reach = list.inverse_reach.data() + first;
  const double* stiffness = list.tangential_stiffness.data() + first;
  double* start_x = list.start_x.data() + first;
  double* start_y = list.start_y.data() + first;
  double* start_roll = list.start_roll.data() + first;
  double* start_force = list.start_force.data() + first;
  double* forces = &list.forces[first].x;
  for (std::size_t c = 0; c < size; c += width) {
    const V x = load<width>(at.x + c);
    const V y = load<width>(at.y + c);
    const V distance = load<width>(at.distance + c);
    const V inverse = load<width>(at.inverse + c);
    const V fn = load<width>(at.normal_force + c);
    V turn;
    if constexpr (far) {
      const V dot = load<width>(start_x + c) * x + load<width>(start_y + c) * y;
      const V cross = load<width>(start_x + c) * y - load<width>(start_y + c) * x;
      const V half = cross / largest(distance + dot, 1e-12 * distance);
      const V quarter = half / (1 + square_root(1 + half * half));
      turn = 8 * arc_tangent(quarter / (1 + square_root(1 + quarter * quarter)));
    } else {
      turn = arc_tangent(load<width>(at.tangent + c));
    }
    V slip = distance * turn;
    const V stretch = distance * load<width>(inverse_reach + c);
    const V roll = load<width>(at.roll + c);
    if constexpr (rotating) slip += stretch * (load<width>(start_roll + c) - roll);
    const V kt = load<width>(stiffness + c);
    const V start = load<width>(start_force + c);
    const V trial = start - kt * slip;
    const V bound = friction * fn;
    const V ft = smallest(largest(trial, -bound), bound);
    put_records<width>((fn * x - ft * y) * inverse, (fn * y + ft * x) * inverse,
                       rotating ? -stretch * ft : zero, zero, forces + 4 * c);
    if constexpr (advance) {
      // Sliding at ft, and what the spring gives up when the bound falls below its force.
      const V excess = largest(magnitude(start) - bound, zero);
      const V lost = (magnitude(ft * (trial - ft)) + 0.5 * excess * excess) / kt;
      dissipated.add(c, kt > zero ? lost : zero);
      store(start_x + c, x * inverse);
      store(start_y + c, y * inverse);
      if constexpr (rotating) store(start_roll + c, roll);
      store(start_force + c, ft);
    }
  }
}

template <std::size_t width, Kinematics kinematics, bool far, bool advance>
GRAINLAW_INLINE LoopResult contact_loop(const Loop& loop) {
  using V = Lanes<width>;
  ContactList& list = *loop.list;
  V beyond{};
  GroupSum<width> dissipated;
  Block at;
  for (std::size_t first = 0; first < list.i.size(); first += block) {
    const std::size_t size = std::min(block, list.i.size() - first);
    find_branches<width>(&loop.particles->x, list, first, size, at);
    if constexpr (kinematics == Kinematics::frictionless) {
      for (std::size_t c = 0; c < size; c += width) {
        const V x = load<width>(at.x + c);
        const V y = load<width>(at.y + c);
        const V distance = square_root(x * x + y * y + tiny);
        const V overlap = load<width>(at.reach + c) - distance;
        const V fn = load<width>(&list.normal_stiffness[first + c]) * largest(overlap, V{});
        const V f = fn / distance;
        put_records<width>(f * x, f * y, V{}, V{}, &list.forces[first + c].x);
      }
    } else {
      beyond = largest(beyond, find_normals<width>(list, first, size, at));
      find_forces<width, kinematics, far, advance>(loop.friction, list, first, size, at,
                                                   dissipated);
    }
  }
  return {most(beyond), dissipated.total()};
}

// Records (kn, kn, kt d^2 / (R_i + R_j), 1) of the touching contacts.
template <std::size_t width>
GRAINLAW_INLINE ContactTotals stiffness_loop(const Loop& loop) {
  using V = Lanes<width>;
  ContactList& list = *loop.list;
  const V zero{};
  const V one = zero + 1.0;
  GroupSum<width> force, weight, touching;
  const bool weighted = !list.weight.empty();
  Block at;
  for (std::size_t first = 0; first < list.i.size(); first += block) {
    const std::size_t size = std::min(block, list.i.size() - first);
    find_branches<width>(&loop.particles->x, list, first, size, at);
    for (std::size_t c = 0; c < size; c += width) {
      const V x = load<width>(at.x + c);
      const V y = load<width>(at.y + c);
      const V square = x * x + y * y + tiny;
      const V overlap = load<width>(at.reach + c) - square_root(square);
      const auto here = overlap > zero;
      const V kn = here ? load<width>(&list.normal_stiffness[first + c]) : zero;
      const V kt = here ? load<width>(&list.tangential_stiffness[first + c]) : zero;
      const V touches = here ? one : zero;
      force.add(c, kn * overlap);
      touching.add(c, touches);
      if (weighted) weight.add(c, here ? load<width>(&list.weight[first + c]) : zero);
      put_records<width>(kn, kn, kt * square * load<width>(&list.inverse_reach[first + c]),
                         touches, &list.forces[first + c].x);
    }
  }
  return {force.total(), weighted ? weight.total() : touching.total(),
          static_cast<int>(touching.total())};
}

#define GRAINLAW_LOOP(Result, name, loop_of, ...)                                  \
  GRAINLAW_CLONES_OF_FOUR Result name##_of_four(const Loop& loop) {                \
    return loop_of<4 __VA_OPT__(, ) __VA_ARGS__>(loop);                            \
  }                                                                                \
  GRAINLAW_OF_EIGHT Result name##_of_eight(const Loop& loop) {                     \
    return loop_of<8 __VA_OPT__(, ) __VA_ARGS__>(loop);                            \
  }                                                                                \
  Result name(const Loop& loop) {                                                  \
    return eight_lanes() ? name##_of_eight(loop) : name##_of_four(loop);           \
  }
GRAINLAW_LOOP(LoopResult, frictionless, contact_loop, Kinematics::frictionless, false, false)
GRAINLAW_LOOP(LoopResult, locked_near, contact_loop, Kinematics::locked, false, false)
GRAINLAW_LOOP(LoopResult, locked_far, contact_loop, Kinematics::locked, true, false)
GRAINLAW_LOOP(LoopResult, locked_advancing, contact_loop, Kinematics::locked, true, true)
GRAINLAW_LOOP(LoopResult, rotating_near, contact_loop, Kinematics::rotating, false, false)
GRAINLAW_LOOP(LoopResult, rotating_far, contact_loop, Kinematics::rotating, true, false)
GRAINLAW_LOOP(LoopResult, rotating_advancing, contact_loop, Kinematics::rotating, true, true)
GRAINLAW_LOOP(ContactTotals, stiffnesses, stiffness_loop)
#undef GRAINLAW_LOOP

}  // namespace

void evaluate_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                       ContactList& list, std::span<ForceRecord> forces) {
  const Loop loop{particles.data(), law.friction, &list};
  if (!law.tangential()) {
    frictionless(loop);
  } else {
    if (!list.turns_far) {
      list.turns_far = (law.rotating() ? rotating_near(loop) : locked_near(loop)).beyond > 0;
    }
    if (list.turns_far) law.rotating() ? rotating_far(loop) : locked_far(loop);
  }
  list.sums.add_up(list.forces, opposite, forces);
}

double advance_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                        ContactList& list, std::span<ForceRecord> forces) {
  if (!law.tangential()) {
    evaluate_contacts(particles, law, list, forces);
    return 0;
  }
  const Loop loop{particles.data(), law.friction, &list};
  list.turns_far = false;
  const auto result = law.rotating() ? rotating_advancing(loop) : locked_advancing(loop);
  list.sums.add_up(list.forces, opposite, forces);
  return result.dissipated;
}

ContactTotals sum_stiffnesses(std::span<const ParticleRecord> particles, ContactList& list,
                              std::span<ForceRecord> sums) {
  const auto totals = stiffnesses({particles.data(), 0, &list});
  list.sums.add_up(list.forces, {1, 1, 1, 1}, sums);
  return totals;
}

ContactPoint contact_point(const ContactList& list, std::size_t c,
                           std::span<const double> coordinates, std::size_t particles,
                           const ContactLaw& law) {
  const double* x = coordinates.data();
  const double* y = x + particles;
  const auto p = static_cast<std::size_t>(list.i[c]);
  const auto q = static_cast<std::size_t>(list.j[c]);
  ContactPoint point{};
  point.branch_x = x[q] - x[p] + list.offset_x[c];
  point.branch_y = y[q] - y[p] + list.offset_y[c];
  point.distance =
      std::sqrt(point.branch_x * point.branch_x + point.branch_y * point.branch_y + tiny);
  point.normal_x = point.branch_x / point.distance;
  point.normal_y = point.branch_y / point.distance;
  const double overlap = list.reach[c] - point.distance;
  if (overlap <= 0) return point;
  point.status = ContactStatus::sticking;
  point.normal_force = list.normal_stiffness[c] * overlap;
  if (!law.tangential()) return point;
  point.turn =
      std::atan2(list.start_x[c] * point.branch_y - list.start_y[c] * point.branch_x,
                 list.start_x[c] * point.branch_x + list.start_y[c] * point.branch_y);
  if (law.rotating()) {
    const double* rotation = y + particles;
    point.turn += list.start_roll[c] / list.reach[c] - list.lever_i[c] * rotation[p] -
                  (1 - list.lever_i[c]) * rotation[q];
  }
  const double trial =
      list.start_force[c] - list.tangential_stiffness[c] * point.distance * point.turn;
  const double bound = law.friction * point.normal_force;
  point.tangential_force = std::clamp(trial, -bound, bound);
  if (std::abs(trial) > bound) point.status = ContactStatus::sliding;
  return point;
}

std::array<double, 9> contact_stiffness(const ContactPoint& point, double kn, double kt,
                                        double friction) {
  const double d = point.distance;
  const double fn = point.normal_force;
  const double ft = point.tangential_force;
  double by_normal = -kt * point.turn;
  double by_tangential = -kt;
  double by_rotation = kt * d;
  if (point.status == ContactStatus::sliding) {
    by_normal = std::copysign(friction * kn, -ft);
    by_tangential = 0;
    by_rotation = 0;
  }
  return {-kn,
          -ft / d,
          0,
          by_normal,
          by_tangential + fn / d,
          by_rotation,
          ft + d * by_normal,
          d * by_tangential,
          d * by_rotation};
}

}  // namespace grainlaw

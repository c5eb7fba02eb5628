#include "contact/frictional.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GRAINLAW_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define GRAINLAW_CLONES
#endif

namespace grainlaw {

namespace {

// The angle from a unit vector to a branch of length d with these inner and cross products: four
// times the arc tangent of a quarter of it, by its series; to round-off below 60 degrees, to 1e-11
// at 86, far beyond what an increment turns a branch. No trigonometric call, so that the loop
// vectorises.
inline __attribute__((always_inline)) double turning(double dot, double cross, double d) {
  const double half = cross / std::max(d + dot, 1e-12 * d);
  const double t = half / (1 + std::sqrt(1 + half * half));
  const double u = t * t;
  double series = 1.0 / 23;
  series = 1.0 / 21 - u * series;
  series = 1.0 / 19 - u * series;
  series = 1.0 / 17 - u * series;
  series = 1.0 / 15 - u * series;
  series = 1.0 / 13 - u * series;
  series = 1.0 / 11 - u * series;
  series = 1.0 / 9 - u * series;
  series = 1.0 / 7 - u * series;
  series = 1.0 / 5 - u * series;
  series = 1.0 / 3 - u * series;
  series = 1.0 - u * series;
  return 4 * t * series;
}

constexpr double tiny = std::numeric_limits<double>::min();

GRAINLAW_CLONES
void evaluate_frictionless(const double* x, const double* y, const std::array<double, 4>& cell,
                           std::size_t size, const ContactList& list, double* force_x,
                           double* force_y) {
  const std::int32_t* ci = list.i.data();
  const std::int32_t* cj = list.j.data();
  const double* s0 = list.shift_x.data();
  const double* s1 = list.shift_y.data();
  const double* reach = list.reach.data();
  const double* kn = list.normal_stiffness.data();
  const double h0 = cell[0], h1 = cell[1], h2 = cell[2], h3 = cell[3];
#pragma omp simd
  for (std::size_t c = 0; c < size; ++c) {
    const double lx = x[cj[c]] - x[ci[c]] + h0 * s0[c] + h1 * s1[c];
    const double ly = y[cj[c]] - y[ci[c]] + h2 * s0[c] + h3 * s1[c];
    const double d = std::sqrt(lx * lx + ly * ly + tiny);
    const double overlap = reach[c] - d;
    const double f = (overlap > 0 ? kn[c] * overlap : 0.0) / d;
    force_x[c] = f * lx;
    force_y[c] = f * ly;
  }
}

// Returns the energy dissipated since the history's start when `advance` moves that start here [J].
template <bool rotating, bool advance>
inline __attribute__((always_inline)) double frictional_loop(const double* x, const double* y,
                                                             const double* rotation,
                                                             const std::array<double, 4>& cell,
                                                             double friction, std::size_t size,
                                                             ContactList& list) {
  double* force_x = list.force_x.data();
  double* force_y = list.force_y.data();
  double* couple = list.couple.data();
  const std::int32_t* ci = list.i.data();
  const std::int32_t* cj = list.j.data();
  const double* s0 = list.shift_x.data();
  const double* s1 = list.shift_y.data();
  const double* reach = list.reach.data();
  const double* lever = list.lever_i.data();
  const double* kn = list.normal_stiffness.data();
  const double* kt = list.tangential_stiffness.data();
  double* nx0 = list.start_x.data();
  double* ny0 = list.start_y.data();
  double* turn0 = list.start_turn.data();
  double* ft0 = list.start_force.data();
  double dissipated = 0;
  const double h0 = cell[0], h1 = cell[1], h2 = cell[2], h3 = cell[3];
#pragma omp simd reduction(+ : dissipated)
  for (std::size_t c = 0; c < size; ++c) {
    const double lx = x[cj[c]] - x[ci[c]] + h0 * s0[c] + h1 * s1[c];
    const double ly = y[cj[c]] - y[ci[c]] + h2 * s0[c] + h3 * s1[c];
    const double d = std::sqrt(lx * lx + ly * ly + tiny);
    const double overlap = reach[c] - d;
    const double fn = overlap > 0 ? kn[c] * overlap : 0.0;
    double turn = turning(nx0[c] * lx + ny0[c] * ly, nx0[c] * ly - ny0[c] * lx, d);
    if constexpr (rotating) {
      turn += turn0[c] - lever[c] * rotation[ci[c]] - (1 - lever[c]) * rotation[cj[c]];
    }
    const double trial = ft0[c] - kt[c] * d * turn;
    const double bound = friction * fn;
    const double ft = std::min(std::max(trial, -bound), bound);
    const double inverse = 1 / d;
    force_x[c] = (fn * lx - ft * ly) * inverse;
    force_y[c] = (fn * ly + ft * lx) * inverse;
    if constexpr (rotating) couple[c] = d * ft;
    if constexpr (advance) {
      // Sliding at ft, and what the spring gives up when the bound falls below its force.
      const double excess = std::max(std::abs(ft0[c]) - bound, 0.0);
      dissipated += (std::abs(ft * (trial - ft)) + 0.5 * excess * excess) / kt[c];
      nx0[c] = lx * inverse;
      ny0[c] = ly * inverse;
      if constexpr (rotating) {
        turn0[c] = lever[c] * rotation[ci[c]] + (1 - lever[c]) * rotation[cj[c]];
      }
      ft0[c] = ft;
    }
  }
  return dissipated;
}

template <bool rotating, bool advance>
double frictional(std::span<const double> coordinates, std::size_t particles,
                  const std::array<double, 4>& cell, double friction, ContactList& list);

#define GRAINLAW_KERNEL(rotating, advance)                                                         \
  template <>                                                                                      \
  GRAINLAW_CLONES double frictional<rotating, advance>(                                            \
      std::span<const double> coordinates, std::size_t particles,                                  \
      const std::array<double, 4>& cell, double friction, ContactList& list) {                     \
    const double* x = coordinates.data();                                                          \
    return frictional_loop<rotating, advance>(x, x + particles, x + 2 * particles, cell, friction, \
                                              list.size(), list);                                  \
  }
GRAINLAW_KERNEL(true, false)
GRAINLAW_KERNEL(true, true)
GRAINLAW_KERNEL(false, false)
GRAINLAW_KERNEL(false, true)
#undef GRAINLAW_KERNEL

}  // namespace

void evaluate_contacts(std::span<const double> coordinates, std::size_t particles,
                       const std::array<double, 4>& cell, const ContactLaw& law,
                       ContactList& list) {
  if (law.rotating()) {
    frictional<true, false>(coordinates, particles, cell, law.friction, list);
  } else if (law.tangential()) {
    frictional<false, false>(coordinates, particles, cell, law.friction, list);
  } else {
    const double* x = coordinates.data();
    evaluate_frictionless(x, x + particles, cell, list.size(), list, list.force_x.data(),
                          list.force_y.data());
  }
}

double advance_contacts(std::span<const double> coordinates, std::size_t particles,
                        const std::array<double, 4>& cell, const ContactLaw& law,
                        ContactList& list) {
  if (law.rotating()) {
    return frictional<true, true>(coordinates, particles, cell, law.friction, list);
  }
  if (law.tangential()) {
    return frictional<false, true>(coordinates, particles, cell, law.friction, list);
  }
  evaluate_contacts(coordinates, particles, cell, law, list);
  return 0;
}

void accumulate_forces(const ContactList& list, std::size_t particles, bool rotating,
                       std::span<double> forces) {
  std::fill(forces.begin(), forces.end(), 0.0);
  double* rx = forces.data();
  double* ry = rx + particles;
  double* moment = ry + particles;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto p = static_cast<std::size_t>(list.i[c]);
    const auto q = static_cast<std::size_t>(list.j[c]);
    rx[p] -= list.force_x[c];
    ry[p] -= list.force_y[c];
    rx[q] += list.force_x[c];
    ry[q] += list.force_y[c];
    if (!rotating) continue;
    moment[p] -= list.lever_i[c] * list.couple[c];
    moment[q] -= (1 - list.lever_i[c]) * list.couple[c];
  }
}

ContactPoint contact_point(const ContactList& list, std::size_t c,
                           std::span<const double> coordinates, std::size_t particles,
                           const std::array<double, 4>& cell, const ContactLaw& law) {
  const double* x = coordinates.data();
  const double* y = x + particles;
  const auto p = static_cast<std::size_t>(list.i[c]);
  const auto q = static_cast<std::size_t>(list.j[c]);
  ContactPoint point{};
  point.branch_x = x[q] - x[p] + cell[0] * list.shift_x[c] + cell[1] * list.shift_y[c];
  point.branch_y = y[q] - y[p] + cell[2] * list.shift_x[c] + cell[3] * list.shift_y[c];
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
      turning(list.start_x[c] * point.branch_x + list.start_y[c] * point.branch_y,
              list.start_x[c] * point.branch_y - list.start_y[c] * point.branch_x, point.distance);
  if (law.rotating()) {
    const double* rotation = y + particles;
    point.turn +=
        list.start_turn[c] - list.lever_i[c] * rotation[p] - (1 - list.lever_i[c]) * rotation[q];
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

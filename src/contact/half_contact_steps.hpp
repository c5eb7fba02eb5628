// What loops over half contacts of discs and spheres share: a step of a relaxation, in double or
// single precision.
#pragma once

#include "contact/disc_columns.hpp"
#include "contact/half_contacts.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>

namespace grainlaw::core::half_contact_steps {

using namespace simd;
using disc_loops::GroupSum;

// Nodes that a register of so many doubles takes at once.
template <int D, class Real, std::size_t doubles>
inline constexpr std::size_t nodes_at_once = std::min(HalfContactColumns<D>::lanes,
                                                      doubles * sizeof(double) / sizeof(Real));

template <int D, class Real>
struct Step {
  using Columns = HalfContactColumns<D>;

  std::span<const HalfContactRows> groups;
  const typename Columns::template DragOf<Real>* drags;  // null: none
  const typename Columns::template HalfContactOf<Real>* half_contacts;
  typename Columns::template NodesOf<Real>* nodes;
  const Real* displacements;  // records
  Real* next_displacements;   // out
  Real curvature, friction, ratio, keep, gain;
};

StepMeasures take_step(const Step<2, double>& step, bool rotating);
StepMeasures take_step(const Step<2, float>& step, bool rotating);
StepMeasures take_step(const Step<3, double>& step, bool rotating);
StepMeasures take_step(const Step<3, float>& step, bool rotating);

// Loops step_* of every width, from step_loop.
#define GRAINLAW_STEP_LOOPS(D, Real)                                                             \
  GRAINLAW_BY_LANES(StepMeasures, step_locked, step_loop, (const Step<D, Real>& loop), (loop),   \
                    false, false)                                                                \
  GRAINLAW_BY_LANES(StepMeasures, step_locked_dragged, step_loop, (const Step<D, Real>& loop),   \
                    (loop), false, true)                                                         \
  GRAINLAW_BY_LANES(StepMeasures, step_rotating, step_loop, (const Step<D, Real>& loop), (loop), \
                    true, false)                                                                 \
  GRAINLAW_BY_LANES(StepMeasures, step_rotating_dragged, step_loop, (const Step<D, Real>& loop), \
                    (loop), true, true)

// Takes a step by these loops.
#define GRAINLAW_TAKE_STEP(D, Real)                                                       \
  StepMeasures half_contact_steps::take_step(const Step<D, Real>& step, bool rotating) {  \
    if (step.drags == nullptr) return rotating ? step_rotating(step) : step_locked(step); \
    return rotating ? step_rotating_dragged(step) : step_locked_dragged(step);            \
  }

// Stores values in units of the steps; doubles have the unit 1.
template <class Real, std::size_t width>
GRAINLAW_INLINE void put_as(const Lanes<width>& value, double per_unit, Real* to) {
  if constexpr (std::is_same_v<Real, double>) {
    store(to, value);
  } else {
    store(to, __builtin_convertvector(value * per_unit, Lanes<width, float>));
  }
}

// Masses of nodes and their inverses, from the sums of stiffnesses.
template <class Real, std::size_t width>
GRAINLAW_INLINE void put_mass(const Lanes<width>& sum, const double* least, double factor,
                              double per_stiffness, Real* mass, Real* gain) {
  const Lanes<width> value = factor * largest(sum, load<width>(least));
  put_as<Real, width>(value, per_stiffness, mass);
  put_as<Real, width>(1 / value, 1 / per_stiffness, gain);
}

// Steps nodes with their forces, one component after another, and sums what is measured.
template <int D, std::size_t width, class Real>
class NodeSteps {
  using V = Lanes<width, Real>;
  using Nodes = typename HalfContactColumns<D>::template NodesOf<Real>;
  // Velocities of discs in double precision are differences of displacements as these are rounded.
  static constexpr bool as_moved = D == 2 && std::is_same_v<Real, double>;

 public:
  GRAINLAW_INLINE explicit NodeSteps(const Step<D, Real>& step)
      : keep_(step.keep), gain_(step.gain) {}

  // Component c of the nodes from lane k on.
  GRAINLAW_INLINE void go_on(Nodes& nodes, std::size_t k, std::size_t c, bool turns, const V& force,
                             V& moved) {
    Real* const velocity = nodes.velocity[c] + k;
    const V v = load<width>(velocity);
    largest_ = largest(largest_, magnitude(force));
    work_ += v * force;
    twice_energy_ += v * load<width>((turns ? nodes.mass_spin : nodes.mass) + k) * v;
    const V next =
        keep_ * v + gain_ * force * load<width>((turns ? nodes.gain_spin : nodes.gain) + k);
    next_work_ += next * force;
    const V before = moved;
    moved += next;
    store(velocity, as_moved ? moved - before : next);
    store(nodes.moved[c] + k, moved);
  }
  // Adds the sums of the nodes from lane k on.
  GRAINLAW_INLINE void end(std::size_t k) {
    power_.add(k, work_);
    next_power_.add(k, next_work_);
    inertia_.add(k, twice_energy_);
    work_ = next_work_ = twice_energy_ = V{};
  }
  GRAINLAW_INLINE StepMeasures measured() const {
    return {most(largest_), power_.total(), next_power_.total(), inertia_.total()};
  }

 private:
  Real keep_, gain_;
  V largest_{}, work_{}, next_work_{}, twice_energy_{};
  GroupSum<width, Real> power_, next_power_, inertia_;
};

}  // namespace grainlaw::core::half_contact_steps

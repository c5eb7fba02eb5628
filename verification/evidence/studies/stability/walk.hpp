// A host that leads one integration point along a path of F and watches the contract on the way.
#pragma once

#include "app/library.hpp"

#include <map>
#include <string>
#include <vector>

namespace verification::stability {

// What a host does with an increment that fails even in its smallest part.
enum class Surrender { end_the_path, skip_the_increment };

template <int D>
struct PathOf {
  std::vector<TensorOf<D>> targets;  // F at the end of every increment; the first starts at F = I
  Surrender surrender = Surrender::end_the_path;
  // When contacts are lost the host takes zero stress at this F and goes on from what is committed.
  bool zero_stress_when_lost = false;
  double cpu_budget = 10;  // of the whole path, which ends when it is spent [s]
};

template <int D>
struct PointOf {
  TensorOf<D> deformation = TensorOf<D>::Identity();
  TensorOf<D> stress = TensorOf<D>::Zero();  // P [Pa]
  bool in_one_part = true;                   // neither the host nor the library split the increment
  bool lost = false;                         // contacts lost; the stress is the host's zero
};

// What a walk of either dimension took, and how it ended.
struct Course {
  int increments = 0;
  int converged = 0;
  int zero_stress = 0;  // increments that ended without contacts
  int evaluations = 0;
  std::map<grainlaw_status, int> failures;
  int halvings = 0;       // most of one increment
  int subincrements = 0;  // of the library, where an increment took more than one
  int advancing = 0;      // evaluations whose friction history advanced: approximate
  int inexact = 0;        // tangents that are not the derivative of P
  int small_steps = 0;    // tried after failures, at 1/1000 of the failed step
  int small_steps_done = 0;
  double relaxation_steps = 0;
  double factorisations = 0;
  double cpu = 0;                // [s]
  double worst_residual = 0;     // [-]
  double work = 0;               // V0 P:dF, trapezoid rule [J]
  double total_work = 0;         // sum of its absolute values [J]
  double stored = 0;             // change of elastic energy [J]
  double dissipated = 0;         // by friction [J]
  double dragged = 0;            // with solver.viscous_number: by drag [J]
  double released = 0;           // in jumps from one equilibrium to another [J]
  bool worked = false;           // more than a rotation does by rounding
  double least_dissipation = 0;  // of one step [J]
  double mean_overlap = 0;       // at the end [m]
  std::string gave_up;           // "", or where and why the path, or an increment, was given up
  std::string violation;         // "", or the first thing that the contract excludes
};

template <int D>
struct WalkOf : Course {
  // F = I, and every increment that reached its target, or zero stress
  std::vector<PointOf<D>> points;
};

// Walks of discs.
using Path = PathOf<2>;
using Point = PointOf<2>;
using Walk = WalkOf<2>;

// An increment in which the packing jumps from one equilibrium to another sets elastic energy free,
// which the relaxation takes away. It stands out: what its work leaves over when the changes of
// stored and dissipated energy are taken from it does not shrink with the increment.
//
// Every evaluation asks for the exact tangent. A failed step is halved up to ten times, a part that
// succeeded doubles the next one.
template <int D>
WalkOf<D> walk(const Material& material, const PathOf<D>& path);

// "NOT_CONVERGED", "CONTACTS_LOST", ...
std::string status_name(grainlaw_status status);

}  // namespace verification::stability

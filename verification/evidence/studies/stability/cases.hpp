// What the stability study runs: one case per row of its table.
#pragma once

#include "evidence/studies/stability/packings.hpp"
#include "evidence/studies/stability/paths.hpp"
#include "evidence/studies/stability/walk.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace verification::stability {

// A result against something known.
struct Check {
  double error = 0;     // relative [-]
  double bar = 0;       // above it the library is wrong
  std::string against;  // what it is compared with
};

struct Walked {
  Course course;
  std::optional<Check> check;  // of a walk that went through
};

struct Case {
  std::string group;
  std::string setting;
  std::function<Material()> material;
  std::function<Walked(const Material&)> walk;
  int increments = 0;
  bool skips = false;          // goes on beyond an increment that failed
  bool judged = true;          // by its check; not where drag keeps P from what that is of
  bool must_converge = false;  // else a documented status will do
};

using Cases = std::vector<Case>;

template <int D>
using CheckOf = std::function<Check(const WalkOf<D>&)>;

// The check may be empty.
void add(Cases& cases, std::string group, std::string setting, std::function<Material()> material,
         Path path, CheckOf<2> check = {});
void add_spheres(Cases& cases, bool must_converge, const std::string& group, std::string setting,
                 std::function<Material()> material, PathOf<3> path, CheckOf<3> check = {});

// kn/p, friction, kt/kn, sizes of discs, and kn/p x friction.
void add_contact_cases(const PackingStore& store, Cases& cases);
// Large, turning, cyclic and random deformation; dilution, no pressure, energy; `yade` is the
// material of the reference packing.
void add_path_cases(const PackingStore& store, const MaterialSource& yade, Cases& cases);
// Closed forms, rattlers, units: what P must be.
void add_exact_cases(const PackingStore& store, Cases& cases);
// All of these kinds with spheres, fewer of each, with what must converge.
void add_sphere_cases(const PackingStore& store, Cases& cases);

// Largest |P - other| over the points of both walks / largest |P| [-].
template <int D>
double stress_distance(const std::vector<PointOf<D>>& points,
                       const std::vector<TensorOf<D>>& other);
std::vector<Tensor> stresses_of(const Walk& walk);
// P of the same increments without rotation, `still`, turned by `angle` in each.
template <int D>
Check against_unrotated(const Material& material, const WalkOf<D>& walk, double angle,
                        const TargetsOf<D>& still);
// Once contacts are lost they stay so until F is dense again, and there the stress is back.
template <int D>
Check bears_again(const WalkOf<D>& walk);

}  // namespace verification::stability

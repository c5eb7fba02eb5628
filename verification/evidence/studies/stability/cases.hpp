// What the stability study runs: one case per row of its table.
#pragma once

#include "evidence/studies/stability/packings.hpp"
#include "evidence/studies/stability/walk.hpp"

#include <functional>
#include <string>
#include <vector>

namespace verification::stability {

// A result against something known.
struct Check {
  double error = 0;     // relative [-]
  double bar = 0;       // above it the library is wrong
  std::string against;  // what it is compared with
};

struct Case {
  std::string group;
  std::string setting;
  std::function<Material()> material;
  Path path;
  std::function<Check(const Walk&)> check;  // of a walk that went through; may be empty
  bool judged = true;  // by that; not where drag keeps P from the equilibrium it is of
};

using Cases = std::vector<Case>;

void add(Cases& cases, std::string group, std::string setting, std::function<Material()> material,
         Path path, std::function<Check(const Walk&)> check = {});

// kn/p, friction, kt/kn, sizes of discs, and kn/p x friction.
void add_contact_cases(const PackingStore& store, Cases& cases);
// Large, turning, cyclic and random deformation; dilution, no pressure, energy; `yade` is the
// material of the reference packing.
void add_path_cases(const PackingStore& store, const MaterialSource& yade, Cases& cases);
// Closed forms, rattlers, units: what P must be.
void add_exact_cases(const PackingStore& store, Cases& cases);

// Largest |P - other| over the points of both walks / largest |P| [-].
double stress_distance(const std::vector<Point>& points, const std::vector<Tensor>& other);
std::vector<Tensor> stresses_of(const Walk& walk);

}  // namespace verification::stability

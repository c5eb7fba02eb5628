// One immutable description of a constitutive law, shared by all its integration points.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/law.hpp"
#include "equilibrium/options.hpp"
#include "generate/generator.hpp"
#include "increment/configuration.hpp"
#include "increment/problem.hpp"
#include "packing/packing.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace grainlaw::core {

template <int D>
struct Material {
  Packing packing;
  ContactLaw law;
  BoundarySpace<D> space;
  SolverOptions solver;
  Configuration<D> initial;       // equilibrium at F = I
  double initial_mean_force = 0;  // mean normal contact force at F = I, or its substitute [N]
  std::uint64_t fingerprint = 0;  // identifies the material of saved states

  // The material as the solvers see it.
  [[nodiscard]] Problem<D> problem() const {
    const double floor =
        solver.force_floor > 0 ? solver.force_floor : relative_floor * initial_mean_force;
    const double overlap = law.hertzian() ? law.typical_overlap : 0;
    return {&packing, &law, &space, floor, solver.tolerance, overlap, solver.inertia};
  }
};

// Content of a material file, before any equilibrium.
struct MaterialDescription {
  Packing packing;
  ContactLaw law;
  BoundaryOptions boundary;
  SolverOptions solver;
  std::optional<GeneratorOptions> generator;  // present: the packing is still to be generated
};

// Cuts the frame if the boundary needs one, and brings the packing to equilibrium at F = I. Throws
// Error (BAD_PACKING, NOT_CONVERGED, CONTACTS_LOST).
template <int D>
std::shared_ptr<const Material<D>> make_material(MaterialDescription description);

}  // namespace grainlaw::core

// Problem: all that is constant over the increments of a material.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/law.hpp"
#include "packing/packing.hpp"

#include <cstddef>

namespace grainlaw::core {

// Default lower bound of the force scale, as a part of the mean force at F = I [-]. Without it a
// packing free of stress would pass as converged.
inline constexpr double relative_floor = 1e-3;

template <int D>
struct Problem {
  const Packing* packing = nullptr;
  const ContactLaw* law = nullptr;
  const BoundarySpace<D>* space = nullptr;
  double force_floor = 0;    // lower bound of the force scale, else the mean normal force [N]
  double tolerance = 0;      // of equilibria; weaker contacts are not load bearing [-]
  double hertz_overlap = 0;  // mean at F = I over the radius; 0: another law, or not known yet [-]
  bool inertia = false;      // increments take time, in which particles have their mass

  [[nodiscard]] std::size_t particles() const { return packing->size(); }
  [[nodiscard]] std::size_t nodes() const { return space->nodes; }
  // Number of unknowns of a node. Spheres without rotation keep theirs, fixed, since blocks are of
  // six.
  [[nodiscard]] int components() const {
    return D == 3 || law->rotating() ? static_cast<int>(Dimension<D>::unknowns) : D;
  }
  [[nodiscard]] std::size_t node_unknowns() const {
    return nodes() * static_cast<std::size_t>(components());
  }
  // Number of unknowns: components of nodes, then those of F if some are found.
  [[nodiscard]] std::size_t unknowns() const {
    return node_unknowns() + (space->finds_deformation ? squared<D> : 0);
  }
  // Number of rows of F that are found, each a record after those of the nodes.
  [[nodiscard]] std::size_t rows() const { return space->finds_deformation ? D : 0; }
};

}  // namespace grainlaw::core

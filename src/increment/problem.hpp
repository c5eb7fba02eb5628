// What stays the same for every increment of a material.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/law.hpp"
#include "packing/packing.hpp"

#include <cstddef>

namespace grainlaw::core {

// Unless a material says otherwise, residuals are never relative to less than this part of the mean
// force at F = I, so that a packing without stress does not pass as converged.
inline constexpr double relative_floor = 1e-3;

template <int D>
struct Problem {
  const Packing* packing = nullptr;
  const ContactLaw* law = nullptr;
  const BoundarySpace<D>* space = nullptr;
  double force_floor = 0;  // residuals are relative to max(mean normal force, this) [N]
  double tolerance = 0;    // of equilibria; contacts that carry about as little are none [-]

  [[nodiscard]] std::size_t particles() const { return packing->size(); }
  [[nodiscard]] std::size_t nodes() const { return space->nodes; }
  // Unknowns of a node. Spheres that do not turn keep theirs, which nothing moves: blocks are of six.
  [[nodiscard]] int components() const {
    return D == 3 || law->rotating() ? static_cast<int>(Dimension<D>::unknowns) : D;
  }
  [[nodiscard]] std::size_t node_unknowns() const {
    return nodes() * static_cast<std::size_t>(components());
  }
  // Components of nodes, and after them those of F where some are found.
  [[nodiscard]] std::size_t unknowns() const {
    return node_unknowns() + (space->finds_deformation ? squared<D> : 0);
  }
  // Rows of F that are unknown, each a record behind those of the nodes.
  [[nodiscard]] std::size_t rows() const { return space->finds_deformation ? D : 0; }
};

}  // namespace grainlaw::core

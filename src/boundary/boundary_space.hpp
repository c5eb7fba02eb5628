// A boundary condition is a linear space of fluctuations, @formula motion with w_q = w_node(q).
// Particles that share a node share its fluctuation, and the forces on them add up to the node's
// residual.
#pragma once

#include "boundary/options.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"
#include "packing/neighbours.hpp"
#include "packing/packing.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace grainlaw::core {

// Bits of BoundarySpace::fixed: one per component of the translation, then of the rotation.
constexpr unsigned char fixed_bit(std::size_t component) {
  return static_cast<unsigned char>(1U << component);
}
template <int D>
inline constexpr unsigned char fixed_translation = fixed_bit(D) - 1;
template <int D>
inline constexpr unsigned char fixed_rotation = fixed_bit(Dimension<D>::unknowns) -
                                                1 - fixed_translation<D>;

// sum_q w_q A_q = 0 over the boundary for the fluctuations in one direction (Liu, Bosco & Suiker
// 2017, eq. 15). It is stored as one or two orthonormal rows over the free nodes, none where no
// node is free. Its multiplier is the stress: a_q = P A_q (eq. 21).
struct AverageConstraint {
  std::vector<std::int32_t> node;
  std::vector<std::array<double, 2>> row;  // per node; the second is 0 when there is one row
  std::size_t rows = 0;
};

// Nodes and constraints by type (Liu, Bosco & Suiker 2017, section 2.3):
//   periodic-cell  one node per particle, nothing fixed
//   frame-p        eqs. 19-20: opposite edge particles share a node; the four corners share one,
//                  whose fluctuation is 0
//   frame-d        eq. 17: one node per particle; boundary nodes are fixed
//   frame-t        eqs. 15, 21-22: one node per particle; the average constraint on the boundary
//   mixed          section 5: each side by its rules
template <int D>
struct BoundarySpace {
  BoundaryOptions options;
  std::size_t nodes = 0;
  bool identity = true;              // node p is particle p, nothing is fixed or constrained
  std::vector<int> node;             // [particles]
  std::vector<unsigned char> fixed;  // [nodes] fixed_bit of prescribed components
  std::vector<char> boundary;        // [nodes] 1: on the frame, 2: and free to rotate
  std::array<AverageConstraint, static_cast<std::size_t>(D)> average;  // per direction
  // Node whose fluctuation per direction is subtracted at the end, where all nodes are periodic in
  // it; -1: none needed. The packing translates freely during the solve, since fixing one node
  // doubles the relaxation steps.
  std::array<int, static_cast<std::size_t>(D)> anchor = none();
  double reference_volume = 0;  // V at F = I, thickness included [m3]
  double solid_volume = 0;      // volume of the particles, copies counted once [m3]
  std::vector<int> source;      // [particles] identity of the particle; copies share it
  std::size_t sources = 0;
  std::vector<int> copies;  // [sources] particles of each identity; empty: one

  // Reference of a condition bound to the axes of space, such as a layer between plates. It does
  // not rotate with the increment. Empty for all other conditions.
  std::vector<double> reference;  // X' of x = F X' + offset + w, component-major [m]
  std::vector<double> offset;     // distance of discs from their rigid row, component-major [m]
  // Components of F that are unknowns, each found from a prescribed component of P.
  bool finds_deformation = false;
  std::array<bool, squared<D>> found{};
  Tensor<D> stress{};  // [Pa]

  [[nodiscard]] bool bound_to_axes() const { return !reference.empty(); }
  [[nodiscard]] bool averages() const {
    std::size_t rows_of_all = 0;
    for (const auto& constraint : average) rows_of_all += constraint.rows;
    return rows_of_all > 0;
  }

  // Drops the contacts within a rigid row.
  void drop(std::vector<NeighbourPair<D>>& pairs) const;

  std::array<bool, 2> copied{};     // left with right, bottom with top: they share fluctuations
  std::vector<unsigned char> rows;  // [particles] bit k: in the row of side k; empty: no row

 private:
  static constexpr std::array<int, static_cast<std::size_t>(D)> none() {
    std::array<int, static_cast<std::size_t>(D)> anchors{};
    anchors.fill(-1);
    return anchors;
  }
};

// The condition of a periodic cell, with its options.
template <int D>
BoundarySpace<D> make_cell_space(const Packing& packing, const BoundaryOptions& options = {});

}  // namespace grainlaw::core

// A boundary condition as a linear space for the fluctuations: particles share the fluctuation of
// their node, x_p = F X_p + w_node(p), and the forces on them add up to the node's residual.
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

// Bits of BoundarySpace::fixed: one for each component of translation, then of rotation.
constexpr unsigned char fixed_bit(std::size_t component) {
  return static_cast<unsigned char>(1U << component);
}
template <int D>
inline constexpr unsigned char fixed_translation = fixed_bit(D) - 1;
template <int D>
inline constexpr unsigned char fixed_rotation = fixed_bit(Dimension<D>::unknowns) -
                                                1 - fixed_translation<D>;

// sum_q w_q A_q = 0 over the boundary, of the fluctuations in one direction (Liu, Bosco & Suiker
// 2017, eq. 15), as one or two orthonormal rows over the nodes that take part; none where nothing
// is free. The multiplier of it is the stress: a_q = P A_q (eq. 21).
struct AverageConstraint {
  std::vector<std::int32_t> node;
  std::vector<std::array<double, 2>> row;  // of each of these nodes; second 0 when there is one
  std::size_t rows = 0;
};

// periodic-cell: one node per particle, nothing fixed. frame-p (Liu, Bosco & Suiker 2017, eqs.
// 19-20): one node per particle of the periodic packing that was cut, so that opposite edge
// particles share theirs, and the four corners share one, kept where F has it. frame-d
// (eq. 17): a node per particle, those of the boundary fixed. frame-t (eqs. 15, 21-22): a node per
// particle, the boundary's under the average constraint. mixed (section 5): each side by its rules.
template <int D>
struct BoundarySpace {
  BoundaryOptions options;
  std::size_t nodes = 0;
  bool identity = true;              // node p is particle p, nothing is fixed or constrained
  std::vector<int> node;             // [particles]
  std::vector<unsigned char> fixed;  // [nodes] bits of Fixed: prescribed
  std::vector<char> boundary;        // [nodes] 1: on the frame, 2: and turns freely
  std::array<AverageConstraint, static_cast<std::size_t>(D)> average;  // by direction
  // What is periodic both ways in a direction may move as a whole in it, and does while an equilibrium
  // is sought: held at one node, a relaxation takes twice as long. Then it is put back to where F has
  // this particle; -1: something else holds it.
  std::array<int, static_cast<std::size_t>(D)> anchor = none();
  double reference_volume = 0;  // V at F = I, thickness included [m3]
  double solid_volume = 0;      // of the particles, copies counted once [m3]
  std::vector<int> source;      // [particles] the particle that it is, copies being the same one
  std::size_t sources = 0;

  // A condition whose directions are those of space, as a layer between plates has them: it does
  // not turn with the increment, and fluctuations keep their components. Empty for all others.
  std::vector<double> reference;  // X' of x = F X' + offset + w, component-major [m]
  std::vector<double> offset;     // of discs from their rigid row, component-major [m]
  // Components of F that are found, so that those of P are the prescribed ones.
  bool finds_deformation = false;
  std::array<bool, squared<D>> found{};
  Tensor<D> stress{};  // [Pa]

  [[nodiscard]] bool bound_to_axes() const { return !reference.empty(); }
  [[nodiscard]] bool averages() const {
    std::size_t rows_of_all = 0;
    for (const auto& constraint : average) rows_of_all += constraint.rows;
    return rows_of_all > 0;
  }

  // Contacts that are left out: those within a row.
  void drop(std::vector<NeighbourPair<D>>& pairs) const;

  std::array<bool, 2> copied{};  // between left and right, bottom and top: the sides are the same
  std::vector<unsigned char> rows;  // [particles] bit k: in the row of side k; empty: none

 private:
  static constexpr std::array<int, static_cast<std::size_t>(D)> none() {
    std::array<int, static_cast<std::size_t>(D)> anchors{};
    anchors.fill(-1);
    return anchors;
  }
};

// The condition of a periodic cell; its options are taken over.
template <int D>
BoundarySpace<D> make_cell_space(const Packing& packing, const BoundaryOptions& options = {});

}  // namespace grainlaw::core

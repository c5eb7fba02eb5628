// The exact stiffness -dr/dz of the reduced residual, and linear solves with it.
#pragma once

#include "equilibrium/block_matrix.hpp"
#include "equilibrium/increment.hpp"

#include <array>
#include <span>
#include <vector>

namespace grainlaw {

class Stiffness {
 public:
  // K of the present coordinates plus shift x mass on the diagonal; rows of prescribed translations
  // are the identity. Forgotten by the next call.
  void assemble(const Increment& increment, double shift);

  // Factorise what was assembled.
  void factorise(Increment& increment);

  // x = K^-1 b, refined while that helps; by pivoting LU when it does not. False when the matrix is
  // singular to working precision.
  bool solve(const Increment& increment, std::span<const double> b, std::span<double> x);

 private:
  void find_graph(const Increment& increment);
  void add_masses(const Increment& increment, double factor);

  BlockMatrix matrix_;
  BlockLU lu_;
  bool factorised_ = false;
  std::vector<Edge> graph_;
  std::vector<std::int32_t> edge_of_contact_;
  std::vector<std::pair<Edge, std::int32_t>> pairs_;
  std::vector<double> check_, correction_;
};

// How the generalised force of a contact acts: C_p of the particles i and j, so that the force and
// moment on p are C_p (fn, ft, d ft); and B_p, so that (normal, tangential displacement, weighted
// rotation) = sum_p B_p z_p. 3 x 3 row-major, local tangent t = (-n_y, n_x).
struct ContactMap {
  std::array<double, 9> force_i, force_j, motion_i, motion_j;
};
ContactMap contact_map(double normal_x, double normal_y, double lever_i);

}  // namespace grainlaw

// The exact stiffness -dr/dz of the reduced residual, and linear solves with it.
#pragma once

#include "base/constants.hpp"
#include "contact/contact_point.hpp"
#include "increment/increment.hpp"
#include "linear/block_lu.hpp"
#include "linear/block_matrix.hpp"
#include "linear/gmres.hpp"
#include "linear/iterative.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace grainlaw::core {

// The derivatives of a contact's forces: of discs in the contact's own frame.
template <int D>
using ContactStiffness = std::conditional_t<D == 2, std::array<double, 9>, SphereStiffness>;

// A contact that touches, at the coordinates of the last assemble().
template <int D>
struct TouchingContact {
  TouchingContact() {}  // filled at once: zeros would take as long as a contact's forces

  std::size_t index;  // in the increment's list
  std::size_t node_i, node_j;
  double lever_i, reach;  // R_i / (R_i + R_j) [-], R_i + R_j [m]
  ContactPoint<D> point;
  ContactStiffness<D> stiffness;  // contact_stiffness() of it
};

// What one increment of deformation left here serves the rest of it: the graph while all contacts
// that touch are in it, the factors for solve_together(). Nothing is carried from one increment to the
// next that could change a bit there: the epoch tells them apart.
template <int D>
class Stiffness {
 public:
  static constexpr std::size_t width = Dimension<D>::lanes;
  using Column = BlockColumn<width>;

  // K of the present coordinates plus shift x mass on the diagonal; rows of what is prescribed are
  // the identity. Where fluctuations are constrained on average, kn row row^T over the anchors is
  // added for every row of the constraint: it holds what only the constraint would hold, in the
  // factors, and BorderedSystem takes it out of the solutions. The factors are no longer those of K.
  void assemble(const Increment<D>& increment, double shift);

  // Add to what was assembled, against the rotation of a node, as much as its mass.
  void hold_rotation(const Increment<D>& increment, std::size_t node) {
    for (std::size_t k = D; k < Dimension<D>::unknowns; ++k) {
      matrix_.block(node)[k].lane[k] += increment.masses().of_unknowns()[k * matrix_.nodes + node];
    }
  }

  // Factorise what was assembled.
  void factorise(Increment<D>& increment);

  // x = K^-1 b of what was factorised, refined until the residual is below the tolerance (largest entry,
  // relative to b) or while that helps; by GMRES where that ends far from it. False when b is not in the
  // range of K to working precision, or the factors are of no use.
  bool solve(const Increment<D>& increment, std::span<const double> b, std::span<double> x,
             double tolerance = 1e-8);

  // A step of Newton's method. Of many spheres it leaves up to `forcing` of b, else as little as
  // solve().
  bool solve_step(Increment<D>& increment, std::span<const double> b, double forcing,
                  std::span<double> x);

  // The same of several vectors together. Of K just assembled, without factorise() before: old factors
  // do when refinement with them converges quickly, else K is factorised here.
  bool solve_together(Increment<D>& increment, std::span<const Together<width>> b,
                      std::span<Together<width>> x);

  // Of spheres, from so many nodes on: by Krylov methods, and by factors where those do not get there
  // with so many products each.
  void iterate_from(std::size_t nodes, int most_products = tuned::most_products) {
    iterative_from_ = nodes;
    most_products_ = most_products;
  }
  // Products that these took so far.
  [[nodiscard]] int products() const {
    if constexpr (D == 3) return iterative_.products;
    return 0;
  }

  // K x of what was assembled, component-major.
  [[nodiscard]] std::vector<double> product(std::span<const double> x) const;

  // Of the last assemble(), ordered by index.
  [[nodiscard]] std::span<const TouchingContact<D>> touching() const { return touching_; }
  // The moments of these contacts; empty for laws without.
  [[nodiscard]] std::span<const ContactMoment<D>> moments() const { return moments_; }

 private:
  void find_touching(const Increment<D>& increment);
  [[nodiscard]] bool graph_serves(const Increment<D>& increment) const;
  void find_graph(const Increment<D>& increment);
  void add_contacts();
  void hold_rotations(const Increment<D>& increment);
  void add_moments();
  void hold_free_spins(const Increment<D>& increment);
  void hold_fixed_nodes(const Increment<D>& increment);
  void link_anchors(const Increment<D>& increment);
  void add_anchors(const Increment<D>& increment);
  void add_masses(const Increment<D>& increment, double factor);
  void add_drag(const Increment<D>& increment);
  bool solve_together_by_factors(const Increment<D>& increment, std::span<const Together<width>> b,
                                 std::span<Together<width>> x);
  bool solve_by_gmres(const Increment<D>& increment);
  void ground(const Increment<D>& increment, double share);
  void set_right(std::span<const double> b);
  void give_solution(std::span<double> x) const;
  [[nodiscard]] bool iterates() const { return D == 3 && matrix_.nodes >= iterative_from_; }
  void prepare_iteration(Increment<D>& increment);
  bool iterate_together(Increment<D>& increment, std::span<const Together<width>> b,
                        std::span<Together<width>> x);

  // Of contacts, instead of an edge.
  static constexpr std::int32_t not_in_graph = -2;
  static constexpr std::int32_t on_the_diagonal = -1;

  enum class Factors { none, of_earlier_matrix, of_matrix };

  BlockMatrix<width> matrix_;
  BlockLU<width> lu_;
  Gmres<width> gmres_;
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<D == 3, Iterative, Nothing> iterative_;
  std::size_t iterative_from_ = tuned::iterative_nodes;
  int most_products_ = tuned::most_products;
  Factors factors_ = Factors::none;
  std::uint64_t factorised_ = 0;  // epoch of the increment that was factorised in last
  std::vector<TouchingContact<D>> touching_;
  std::vector<ContactMoment<D>> moments_;
  std::vector<Edge> graph_;
  std::vector<std::int32_t> edge_of_contact_;
  std::vector<std::int32_t> edge_of_link_;         // between anchors, as add_anchors() goes
  std::vector<std::int32_t> listed_i_, listed_j_;  // the contacts that the graph was made from
  std::vector<std::pair<Edge, std::int32_t>> pairs_;
  std::vector<Column> ground_, right_, solution_, check_;
  std::vector<Together<width>> check_together_, kept_;
};

}  // namespace grainlaw::core

#include "tangent/disc_stiffness.hpp"
#include "tangent/sphere_stiffness.hpp"

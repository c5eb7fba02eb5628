// Exact stiffness -dr/dz of the reduced residual, and linear solves with it.
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

// Derivatives of a contact's forces; those of discs in the frame of the contact.
template <int D>
using ContactStiffness = std::conditional_t<D == 2, std::array<double, 9>, SphereStiffness>;

// Touching contact at the coordinates of the last assemble().
template <int D>
struct TouchingContact {
  TouchingContact() {}  // left uninitialised: zeros would cost as much as the forces

  std::size_t index;  // in the increment's list
  std::size_t node_i, node_j;
  double lever_i, reach;  // R_i / (R_i + R_j) [-], R_i + R_j [m]
  ContactPoint<D> point;
  ContactStiffness<D> stiffness;  // see contact_stiffness()
};

// Stiffness with what later solves of an increment reuse: the matrix graph while it contains all
// touching contacts, and the factors for solve_together(). A new increment, told by its
// epoch, reuses neither, so that its bits depend on nothing before it.
template <int D>
class Stiffness {
 public:
  static constexpr std::size_t width = Dimension<D>::lanes;
  using Column = BlockColumn<width>;

  // Assembles K at the present coordinates plus shift x mass on the diagonal. Rows of prescribed
  // components are the identity. Average constraints add kn row row^T over the anchors, which
  // regularises the factors; BorderedSystem removes its effect from the solutions. Old factors then
  // no longer belong to K.
  void assemble(const Increment<D>& increment, double shift);

  // Regularises the rotation of a node by adding its mass to the diagonal.
  void regularise_rotation(const Increment<D>& increment, std::size_t node) {
    for (std::size_t k = D; k < Dimension<D>::unknowns; ++k) {
      matrix_.block(node)[k].lane[k] += increment.masses().of_unknowns()[k * matrix_.nodes + node];
    }
  }

  // Factorises the assembled matrix.
  void factorise(Increment<D>& increment);

  // Solves x = K^-1 b with the factors. Refinement runs until the residual (largest entry, relative
  // to b) is below the tolerance or falls no more; GMRES follows if it is far off. Returns false if
  // b is outside the range of K to working precision or the factors are unusable.
  bool solve(const Increment<D>& increment, std::span<const double> b, std::span<double> x,
             double tolerance = 1e-8);

  // Solves a Newton step. For many spheres the residual may reach `forcing` x b, otherwise it is
  // that of solve().
  bool solve_step(Increment<D>& increment, std::span<const double> b, double forcing,
                  std::span<double> x);

  // Solves for several vectors with a K just assembled. Old factors serve if refinement with them
  // converges fast, otherwise K is factorised here.
  bool solve_together(Increment<D>& increment, std::span<const Together<width>> b,
                      std::span<Together<width>> x);

  // Sets the number of spheres from which Krylov methods solve, and their most products each before
  // factors take over.
  void iterate_from(std::size_t nodes, int most_products = tuned::most_products) {
    iterative_from_ = nodes;
    most_products_ = most_products;
  }
  // Number of products of the Krylov methods so far.
  [[nodiscard]] int products() const {
    if constexpr (D == 3) return iterative_.products;
    return 0;
  }

  // Product of the assembled K and x, component-major.
  [[nodiscard]] std::vector<double> product(std::span<const double> x) const;

  // Touching contacts of the last assemble(), ordered by index.
  [[nodiscard]] std::span<const TouchingContact<D>> touching() const { return touching_; }
  // Moments of these contacts; empty for laws without moments.
  [[nodiscard]] std::span<const ContactMoment<D>> moments() const { return moments_; }

 private:
  void find_touching(const Increment<D>& increment);
  [[nodiscard]] bool graph_serves(const Increment<D>& increment) const;
  void find_graph(const Increment<D>& increment);
  void add_contacts();
  void regularise_rotations(const Increment<D>& increment);
  void add_moments();
  void add_chord_springs(const Increment<D>& increment);
  void fix_nodes(const Increment<D>& increment);
  void link_anchors(const Increment<D>& increment);
  void add_anchors(const Increment<D>& increment);
  void add_masses(const Increment<D>& increment, double factor);
  void add_drag(const Increment<D>& increment);
  bool solve_together_by_factors(const Increment<D>& increment, std::span<const Together<width>> b,
                                 std::span<Together<width>> x);
  bool solve_by_gmres(const Increment<D>& increment);
  void regularise(const Increment<D>& increment, double share);
  void set_right(std::span<const double> b);
  void give_solution(std::span<double> x) const;
  [[nodiscard]] bool iterates() const { return D == 3 && matrix_.nodes >= iterative_from_; }
  void prepare_iteration(Increment<D>& increment);
  bool iterate_together(Increment<D>& increment, std::span<const Together<width>> b,
                        std::span<Together<width>> x);

  // Values of edge_of_contact_ for contacts without an edge.
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
  std::vector<std::int32_t> edge_of_link_;         // between anchors, in the order of add_anchors()
  std::vector<std::int32_t> listed_i_, listed_j_;  // contacts that the graph was made from
  std::vector<std::pair<Edge, std::int32_t>> pairs_;
  std::vector<Column> regularisation_, right_, solution_, check_;
  std::vector<Together<width>> check_together_, kept_;
};

}  // namespace grainlaw::core

#include "tangent/disc_stiffness.hpp"
#include "tangent/sphere_stiffness.hpp"

// Bordered system [keller1977] of frames. The border of the nodes' stiffness: average constraints
// with their multipliers, and found components of F with their prescribed stresses.
#pragma once

#include "increment/increment.hpp"
#include "tangent/contact_change.hpp"
#include "tangent/stiffness.hpp"

#include <array>
#include <span>
#include <vector>

namespace grainlaw::core {

class BorderedSystem {
 public:
  static bool needed(const BoundarySpace<2>& space) {
    return space.averages() || space.finds_deformation;
  }

  // Solves a Newton step for a residual over all unknowns, with the K and shift of the last
  // assemble(), factorised. The step keeps the averages and cancels the missing stresses. Returns
  // false if the matrix is singular.
  bool solve(Increment<2>& increment, Stiffness<2>& stiffness, double shift,
             std::span<const double> residual, std::span<double> step);

  // Computes the responses to the border, for a K just assembled without shift.
  bool prepare(Increment<2>& increment, Stiffness<2>& stiffness);

  // Completes four motions, with changes of F and of contacts, by the border: averages and
  // prescribed stresses stay. Returns false if the border's matrix is singular.
  bool complete(const Increment<2>& increment, std::span<const TouchingContact<2>> touching,
                std::span<const ContactChange<2>> changes, std::span<ByDeformation<2>> motion,
                DeformationChange<2>& change);

 private:
  static constexpr std::size_t most = 12;  // four averages, four of anchors, four of F
  static constexpr std::size_t lanes = 4;
  using Values = std::array<ByDeformation<2>, most>;  // per row of the border

  enum class Kind { average, anchors, deformation };
  struct Column {
    Kind kind;
    std::size_t direction;  // of the average; or the component of F
    std::size_t row;        // of the average
    // Step between nodes of the average: all nodes, or the anchors alone.
    [[nodiscard]] std::size_t stride(const AverageConstraint& average) const {
      return kind == Kind::anchors ? anchor_stride(average) : 1;
    }
    [[nodiscard]] double mean(const AverageConstraint& average) const {
      return kind == Kind::anchors ? anchor_mean(average)[row] : 0;
    }
  };

  void find_columns(const BoundarySpace<2>& space);
  bool respond(Increment<2>& increment, Stiffness<2>& stiffness, double shift,
               std::span<const double> residual);
  void set_right_side(const Increment<2>& increment, const Stiffness<2>& stiffness,
                      std::size_t group, std::span<const double> residual);
  [[nodiscard]] Values values_of(const Increment<2>& increment,
                                 std::span<const TouchingContact<2>> touching,
                                 std::span<const ContactChange<2>> changes,
                                 std::span<const ByDeformation<2>> motion) const;
  [[nodiscard]] bool eliminate(Values& values) const;

  std::array<Column, most> columns_{};
  std::size_t size_ = 0;
  std::array<std::vector<ByDeformation<2>>, 4>
      response_;  // to the columns, four in each, then to a residual
  std::array<std::array<double, most + 1>, most> matrix_{};  // rows by responses
  std::vector<ByDeformation<2>> right_;
  std::vector<ContactChange<2>> changes_;
};

}  // namespace grainlaw::core

// What borders the stiffness of the nodes: average constraints with their multipliers, and found
// components of F with the stresses that are prescribed for them.
#pragma once

#include "increment/increment.hpp"
#include "tangent/contact_change.hpp"
#include "tangent/stiffness.hpp"

#include <array>
#include <span>
#include <vector>

namespace grainlaw {

class BorderedSystem {
 public:
  static bool needed(const BoundarySpace& space) {
    return space.averages() || space.finds_deformation;
  }

  // Newton's step from a residual over all unknowns: K of the last assemble() with its shift,
  // factorised. Under the step the averages stay and the missing stresses (with the shift's share)
  // vanish. False when the matrix is singular.
  bool solve(Increment& increment, Stiffness& stiffness, double shift,
             std::span<const double> residual, std::span<double> step);

  // Responses to the border itself, of K just assembled without shift.
  bool prepare(Increment& increment, Stiffness& stiffness);

  // Four motions with changes of F and of contacts, completed by what the border adds: averages
  // stay, prescribed stresses do not change. False when it is singular.
  bool complete(const Increment& increment, std::span<const TouchingContact> touching,
                std::span<const ContactChange> changes, std::span<Quad> motion,
                DeformationChange& change);

 private:
  static constexpr std::size_t most = 12;  // four averages, of anchors too, four components of F
  static constexpr std::size_t lanes = 4;
  using Values = std::array<Quad, most>;  // per row of the border

  enum class Kind { average, anchors, deformation };
  struct Column {
    Kind kind;
    std::size_t direction;  // of the average, or the component of F
    std::size_t row;        // of the average
    // Places in the average: all, or those of the anchors.
    [[nodiscard]] std::size_t stride(const AverageConstraint& average) const {
      return kind == Kind::anchors ? anchor_stride(average) : 1;
    }
    [[nodiscard]] double mean(const AverageConstraint& average) const {
      return kind == Kind::anchors ? anchor_mean(average)[row] : 0;
    }
  };

  void find_columns(const BoundarySpace& space);
  bool respond(Increment& increment, Stiffness& stiffness, double shift,
               std::span<const double> residual);
  void set_right_side(const Increment& increment, const Stiffness& stiffness, std::size_t group,
                      std::span<const double> residual);
  [[nodiscard]] Values values_of(const Increment& increment,
                                 std::span<const TouchingContact> touching,
                                 std::span<const ContactChange> changes,
                                 std::span<const Quad> motion) const;
  [[nodiscard]] bool eliminate(Values& values) const;

  std::array<Column, most> columns_{};
  std::size_t size_ = 0;
  std::array<std::vector<Quad>, 4> response_;  // to the columns, four in each, then to a residual
  std::array<std::array<double, most + 1>, most> matrix_{};  // rows by responses
  std::vector<Quad> right_;
  std::vector<ContactChange> changes_;
};

}  // namespace grainlaw

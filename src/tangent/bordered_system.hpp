// The bordered system (Keller 1977) of frames. What borders the stiffness of the nodes: average constraints with their multipliers, and found
// components of F with the stresses that are prescribed for them.
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

  // Newton's step from a residual over all unknowns: K of the last assemble() with its shift,
  // factorised. Under the step the averages stay and the missing stresses (with the shift's share)
  // vanish. False when the matrix is singular.
  bool solve(Increment<2>& increment, Stiffness<2>& stiffness, double shift,
             std::span<const double> residual, std::span<double> step);

  // Responses to the border itself, of K just assembled without shift.
  bool prepare(Increment<2>& increment, Stiffness<2>& stiffness);

  // Four motions with changes of F and of contacts, completed by what the border adds: averages
  // stay, prescribed stresses do not change. False when it is singular.
  bool complete(const Increment<2>& increment, std::span<const TouchingContact<2>> touching,
                std::span<const ContactChange<2>> changes, std::span<ByDeformation<2>> motion,
                DeformationChange<2>& change);

 private:
  static constexpr std::size_t most = 12;  // four averages, of anchors too, four components of F
  static constexpr std::size_t lanes = 4;
  using Values = std::array<ByDeformation<2>, most>;  // per row of the border

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

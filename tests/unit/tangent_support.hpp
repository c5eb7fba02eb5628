// A tangent against central differences, where no contact changes status within the stencil.
#pragma once

#include "support.hpp"

#include <limits>
#include <optional>

namespace grainlaw::core::test {

inline constexpr double bar = 1e-6;  // relative Frobenius error

// What the derivative of the law depends on: who bears, slides, rolls, is bonded.
struct Statuses {
  std::vector<BearingContact> bearing;
  std::vector<bool> rolling;
  double broken_bonds;
  bool operator==(const Statuses&) const = default;
};
inline Statuses statuses(const State& state) {
  constexpr double rounding = 1e-6;
  Statuses result{bearing_contacts(state), {}, measure(state, GRAINLAW_BROKEN_BONDS)};
  const auto& material = state.material();
  if (!material.law.rolls()) return result;
  for (const auto& view : contact_views(material.problem(), state.current())) {
    const double r =
        material.law.common_radius(material.packing.radius[static_cast<std::size_t>(view.i)],
                                   material.packing.radius[static_cast<std::size_t>(view.j)]);
    const double most = material.law.rolling.friction * r * view.normal_force;
    result.rolling.push_back(!view.bonded && std::abs(view.moment[0]) > (1 - rounding) * most);
  }
  return result;
}

// Central differences by all four components of F; none when a contact changes status on the way.
inline std::optional<Tangent> differences_without_change(State& state, const Tensor& F,
                                                         double step) {
  EXPECT_EQ(evaluate(state, F).status, GRAINLAW_OK);
  const auto centre = statuses(state);
  Tangent result{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (const double side : {1.0, -1.0}) {
      Tensor moved = F;
      moved[k] += side * step;
      const Evaluation at = evaluate(state, moved);
      EXPECT_EQ(at.status, GRAINLAW_OK);
      if (statuses(state) != centre) return std::nullopt;
      for (std::size_t m = 0; m < 4; ++m) {
        result[m * 4 + k] += side * at.stress[m] / (2 * step);
      }
    }
  }
  return result;
}

// Differences err too: by the curvature of P over a wide stencil, or a change of status in a
// sub-increment on the way; by the solver's tolerance over a narrow one. A tangent that is wrong
// agrees with none of them.
inline double difference_from_stencils(State& state, const Tensor& F) {
  const Evaluation at = evaluate(state, F, TangentKind::exact);
  EXPECT_EQ(at.status, GRAINLAW_OK);
  EXPECT_EQ(at.report.tangent_exact, 1);
  double least = std::numeric_limits<double>::infinity();
  for (const double step : {1e-6, 3e-7, 1e-7, 3e-8}) {
    const auto differences = differences_without_change(state, F, step);
    if (differences) least = std::min(least, relative_difference(at.tangent, *differences));
    if (least <= bar) break;
  }
  return least;
}

// A contact may change its status at this very F, by chance; then not a little before it too.
inline void expect_derivative(State& state, const Tensor& F) {
  double least = difference_from_stencils(state, F);
  if (std::isinf(least)) {
    const Tensor& from = state.committed().deformation;
    least = difference_from_stencils(state, sum(from, 0.99, sum(F, -1, from)));
  }
  EXPECT_LE(least, bar) << "infinite when a contact changes status in every stencil";
}

struct Path {
  const char* name;
  Tensor reached;  // committed, in steps
  int steps;
  Tensor next;  // where the tangent is taken
};

inline const Path paths[] = {
    {"start", identity, 1, {1.0002, 1e-4, -1e-4, 0.9996}},
    {"compressed", {1.002, 0, 0, 0.996}, 4, {1.0025, 2e-4, -1e-4, 0.995}},
    {"sheared", {1, 0.004, 0.001, 0.999}, 5, {1.0001, 0.005, 0.0011, 0.9987}},
};

inline void expect_derivative_along(const MaterialDescription& description) {
  const auto material = make_material(description);
  for (const Path& path : paths) {
    SCOPED_TRACE(path.name);
    State state(material);
    advance(state, path.reached, path.steps);
    expect_derivative(state, path.next);
    expect_derivative(state, product(rotation(0.7), path.next));
  }
}

}  // namespace grainlaw::core::test

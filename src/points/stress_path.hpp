// A state led by stress: Newton's method on the symmetric stretch with the exact tangent.
#pragma once

#include "points/march.hpp"
#include "state/state.hpp"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace grainlaw::core {

// Orthonormal symmetric tensors B: strains go along them, stresses are led as sigma : B. What is
// not among them keeps its strain, and its stress is found.
template <int D>
using Directions = std::vector<Tensor<D>>;

// All symmetric tensors.
template <int D>
[[nodiscard]] Directions<D> all_directions();
// Those of the traction on the plane across a unit vector.
template <int D>
[[nodiscard]] Directions<D> directions_of_traction(const Vec<D>& normal);

template <int D>
class StressPath {
 public:
  // Starts from the committed state, whose trial is dropped. A step changes the stress by
  // `largest_step` of its norm at most. Throws Error where the start has no equilibrium.
  StressPath(State<D>& state, double largest_step);

  // Leads the directions of `wanted` there [Pa], linearly from where they are. Each part lasts so
  // long that drag fades. Throws Error (NOT_CONVERGED, CONTACTS_LOST, ...) that tells why no part
  // led further; what was committed before stays.
  void lead(const Directions<D>& directions, const Tensor<D>& wanted);

  // Stays there until no drag is left, and meets the stress to the tight tolerance.
  void settle(const Directions<D>& directions, const Tensor<D>& wanted);

  // Stress of the last committed state in balance [Pa].
  [[nodiscard]] const Tensor<D>& carried() const { return carried_; }

 private:
  struct Point {
    Tensor<D> stretch{};  // U: F = U F of the start, symmetric
    Tensor<D> sigma{};    // [Pa]
    Answer<D> answer;     // of the packing's own measure
    double unbalanced = 0;
  };
  struct Attempt {
    Point end;  // committed or the last iterate
    grainlaw_status status = GRAINLAW_OK;
    double ratio = 0;  // of the part, to try next; 0: unknown
    std::string reason;
  };
  struct Linear {
    Eigen::VectorXd value;
    Eigen::MatrixXd slope;
  };

  using Goal = std::function<Eigen::VectorXd(double load)>;  // along the directions [Pa]

  [[nodiscard]] Tensor<D> deformation(const Tensor<D>& stretch) const;
  [[nodiscard]] Linear linearise(const Directions<D>& directions, const Point& point) const;
  bool evaluate(const Tensor<D>& stretch, double duration, Attempt& attempt);
  Told iterate(const Directions<D>& directions, const Eigen::VectorXd& goal, double duration,
               Attempt& attempt);
  void march(const Directions<D>& directions, const Goal& goal, double from, double to,
             double tolerance, double duration);

  State<D>& state_;
  double largest_step_;
  Tensor<D> start_;  // F of the packing there
  Point at_;         // committed
  Tensor<D> carried_{};
};

}  // namespace grainlaw::core

// Newton's method with the exact tangent for a body of bricks.
#pragma once

#include "app/parts.hpp"
#include "brick/model.hpp"

#include <vector>

namespace verification {

struct BrickNewtonOptions {
  double tolerance = 1e-8;  // |residual| / |internal force| [-]
  int max_iterations = 20;  // per attempt; then the step is cut
  int max_cuts = 10;        // halvings of one step
  double loose_tolerance =
      0;                 // accepted at the smallest part of a step, counted as loose; 0: never [-]
  double load_step = 1;  // share of the time, which the points are told as 1
};

struct BrickStep {
  RecordOf<3> record;             // means over the integration points
  std::vector<double> residuals;  // relative, of all iterations; an attempt begins with its load
};

class BrickNewton {
 public:
  // Starts at F = I. Throws ComputationError when that cannot be evaluated.
  BrickNewton(const BrickModel& model, const Material& material, const BrickNewtonOptions& options,
              int threads);

  // Advances to a time in as many parts as needed. Throws StepError.
  BrickStep advance(double to, int number, const CutObserver& observe_cut);

  [[nodiscard]] const BrickField& field() const { return field_; }
  [[nodiscard]] const Eigen::VectorXd& displacement() const { return displacement_; }
  // External minus internal force at the committed time [N].
  [[nodiscard]] const Eigen::VectorXd& residual() const { return system_.residual; }

 private:
  Attempt equilibrate(double time, double tolerance, std::vector<double>& residuals);

  BrickNewtonOptions options_;
  BrickUnknowns unknowns_;
  BrickField field_;
  Eigen::VectorXd displacement_;  // committed [m]
  BrickSystem system_;            // at the committed displacement
  double time_ = 0;               // committed
};

}  // namespace verification

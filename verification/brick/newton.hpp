// Newton's method with the exact tangent for a body of bricks.
#pragma once

#include "app/parts.hpp"
#include "brick/model.hpp"

#include <vector>

namespace verification {

struct BrickNewtonOptions {
  double tolerance = 1e-8;  // |residual| / |internal force| [-]
  int max_iterations = 20;  // of one attempt, then the step is cut
  int max_cuts = 10;        // halvings of one step, at most
  double loose_tolerance =
      0;                 // of a step at its smallest cut, counted as a loose part; 0: never [-]
  double load_step = 1;  // of the time, which the points are told as 1
};

struct BrickStep {
  RecordOf<3> record;             // means over the integration points
  std::vector<double> residuals;  // relative, of all iterations; every attempt begins with its load
};

class BrickNewton {
 public:
  // Throws ComputationError when F = I cannot be evaluated.
  BrickNewton(const BrickModel& model, const Material& material, const BrickNewtonOptions& options,
              int threads);

  // From one time to the next, in parts where need be. Throws StepError.
  BrickStep advance(double to, int number, const CutObserver& observe_cut);

  [[nodiscard]] const BrickField& field() const { return field_; }
  [[nodiscard]] const Eigen::VectorXd& displacement() const { return displacement_; }
  // External minus internal force there [N].
  [[nodiscard]] const Eigen::VectorXd& residual() const { return system_.residual; }

 private:
  Attempt equilibrate(double time, double tolerance, std::vector<double>& residuals);

  BrickNewtonOptions options_;
  BrickUnknowns unknowns_;
  BrickField field_;
  Eigen::VectorXd displacement_;  // committed [m]
  BrickSystem system_;            // there
  double time_ = 0;               // committed
};

}  // namespace verification

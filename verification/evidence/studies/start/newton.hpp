// The drained test of one point by plain Newton iteration, step by step, with what became of each.
#pragma once

#include "app/library.hpp"

#include <functional>
#include <string>
#include <vector>

namespace verification::start {

enum class Lateral { cauchy, piola };  // the stress that is kept

struct Iterate {
  double lateral_stretch;  // F11 [-]
  double residual;         // (stress - target) / |target| [-]
};

struct Step {
  int step = 0;
  double strain = 0;       // axial, at the end [-]
  bool converged = false;  // in one go, within the iterations
  int iterations = 0;      // evaluations of the one go
  int evaluations = 0;     // parts of a step that did not converge included
  double cpu = 0;          // of all of them [ms]
  int parts = 1;           // the step was taken in
  int loose = 0;           // of these, accepted at their best iterate
  int not_direct = 0;      // evaluations of the one go with sub-increments or advanced history
  std::string reason;      // "", or why it did not converge
  std::vector<Iterate> iterates;
  // |P - P'| / |P'| with P' of the same F from the committed state alone; of converged steps [-].
  double dependence = 0;

  [[nodiscard]] double best_residual() const;
  // The two nearest iterates on either side of the target: their distance / the axial increment,
  // and how far apart their residuals are.
  struct Gap {
    double width = 0;  // [-]
    double jump = 0;   // [-]
  };
  [[nodiscard]] Gap gap(double axial_increment) const;
};

struct Run {
  std::string start;  // "committed" or "trial"
  std::string packing;
  std::vector<Step> steps;
  std::string gave_up;  // "", or why the path ends early
};

struct NewtonOptions {
  double axial = 0.1;  // strain at the end [-]
  int steps = 100;
  double tolerance = 1e-10;  // of the lateral stress, relative [-]
  int max_iterations = 15;
  Lateral lateral = Lateral::cauchy;
};

// Prescribed: F22, and the lateral stress at its value at F = I; F12 = F21 = 0; unknown: F11. The
// first guess extrapolates by the tangent of the last step; every iterate takes the full step of the
// exact tangent. Line searches and bracketing were tried and did not converge in more steps. A step
// that does not converge is taken in halves, and at last loosely.
void lead(Run& run, const Material& material, const NewtonOptions& options,
          const std::function<void(const Step&)>& observe);

}  // namespace verification::start

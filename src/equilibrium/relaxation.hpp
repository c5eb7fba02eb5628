// Damped relaxation in pseudo-time towards equilibrium, with unit steps and masses that follow the
// contacts. @formula relaxation
#pragma once

#include "base/constants.hpp"
#include "contact/half_contacts.hpp"
#include "equilibrium/subspace_extrapolation.hpp"
#include "increment/increment.hpp"

#include <limits>
#include <vector>

namespace grainlaw::core {

// Memory of relaxations, reused from call to call.
template <int D>
struct RelaxationMemory {
  std::vector<double> velocity, gain;
  HalfContacts<D> half_contacts;
  SubspaceExtrapolation<D> slow;
  // Steps above tuned::single_precision may be in it. Where Newton follows, discs keep the digits on
  // which hosts agree whose F differ by rounding.
  bool single_precision = D == 3;
};

// Viscous relaxation. The damping follows the lowest active frequency, and its lower bound adapts
// to flutter. Where soft modes creep, the relaxation extrapolates along them.
template <int D>
class Relaxation {
 public:
  // Starts at rest at the present coordinates. An extrapolation may end on another branch of
  // equilibria.
  Relaxation(Increment<D>& increment, History history, RelaxationMemory<D>& memory,
             bool may_extrapolate = true);

  // Relaxes until residual_norm() < tolerance, for at most `steps` more steps, and returns whether
  // it converged. It also stops if the mean contact force is below `least_force` [N] or friction
  // flutters. Coordinates may change between two calls.
  bool run(double tolerance, long steps, double least_force = 0);

 private:
  static constexpr std::size_t width = Dimension<D>::lanes;
  using Measured = StepMeasures;

  void refresh();
  [[nodiscard]] bool may_skip_refresh() const;
  Measured one_step(double keep, double gain);
  Measured step_nodes(double keep, double gain);
  void update();
  [[nodiscard]] double size() const;  // packing size over tuned::usual_nodes [-], at least 1
  void review_floor();
  bool extrapolate();
  [[nodiscard]] bool flutters() const;
  void step();
  void step_deformation();

  Increment<D>& increment_;
  const Problem<D>& problem_;
  Motion<D>& motion_;
  History history_;
  RelaxationMemory<D>& memory_;
  bool by_half_contacts_ = false;  // HalfContacts computes forces and steps
  bool fused_ = false;             // sums of forces and steps are one loop
  bool arranged_ = false;          // HalfContacts has the contacts listed at present
  bool at_rest_ = true;            // there are no velocities to keep
  bool friction_noise_ = false;    // with friction, and forces a function of positions
  bool extrapolates_ = false;      // in the subspace of the last displacements
  double residual_ = 0;            // before the last step [-]; infinite: no contact, or not finite
  double power_ = 0;               // sum of the last step's velocity times the residual before it
  double frequency_ = 0;           // square root of the velocity's Rayleigh quotient [1/step]
  double floor_ = tuned::first_floor;  // lower bound of the damping [-]
  long steps_ = 0;
  long next_extrapolation_ = tuned::first_extrapolation;  // earliest step
  double pause_ = 0;                                      // after the last extrapolation [steps]
  double refresh_start_ = 0,
         refresh_max_ = 0;  // residual at the last relinearisation, largest since
  double check_max_ = 0, check_min_ = std::numeric_limits<double>::infinity();  // since last check
  double window_start_ = std::numeric_limits<double>::infinity();
  double window_max_ = 0, window_min_ = std::numeric_limits<double>::infinity();
  double least_max_ = std::numeric_limits<double>::infinity();  // least window_max_
  long last_gain_ = 0;  // step of the last fall of least_max_
};

// Runs a relaxation once, from rest.
template <int D>
bool relax(Increment<D>& increment, double tolerance, long max_steps, History history,
           RelaxationMemory<D>& memory, double least_force = 0, bool may_extrapolate = true);

}  // namespace grainlaw::core

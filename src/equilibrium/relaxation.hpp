// Damped relaxation in pseudo-time towards equilibrium: unit steps, masses that follow the
// contacts.
#pragma once

#include "base/constants.hpp"
#include "contact/contact_sides.hpp"
#include "equilibrium/subspace_extrapolation.hpp"
#include "increment/increment.hpp"

#include <limits>
#include <vector>

namespace grainlaw::core {

// Memory of the relaxations, reused from call to call.
template <int D>
struct RelaxationMemory {
  std::vector<double> velocity, gain;
  ContactSides<D> sides;
  SubspaceExtrapolation<D> slow;
};

// Viscous relaxation: the damping follows the lowest active frequency, and its floor adapts to
// flutter. Where soft modes creep under it, the relaxation extrapolates along them.
template <int D>
class Relaxation {
 public:
  // At rest at the present coordinates. An extrapolation may end on another branch of equilibria.
  Relaxation(Increment<D>& increment, History history, RelaxationMemory<D>& memory,
             bool may_extrapolate = true);

  // Go on until residual_norm() < tolerance, at most `steps` further steps. Returns whether it got
  // there. Ends too when no more than `least_force` is left of the mean contact force [N], or when
  // friction keeps it fluttering. The coordinates may be changed between two calls.
  bool run(double tolerance, long steps, double least_force = 0);

 private:
  static constexpr std::size_t width = Dimension<D>::lanes;
  using Measured = typename ContactSides<D>::Measured;

  void refresh();
  [[nodiscard]] bool calm() const;
  Measured one_step(double keep, double gain);
  Measured step_nodes(double keep, double gain);
  void update();
  [[nodiscard]] double size() const;  // of the packing, over 400 nodes; 1 where there are fewer
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
  bool by_sides_ = false;      // forces and steps by ContactSides
  bool at_once_ = false;       // nothing comes between the sums of forces and the step
  bool arranged_ = false;      // of the contacts listed at present
  bool at_rest_ = true;        // no velocities to keep
  bool rough_ = false;         // friction, and forces a function of the places
  bool extrapolates_ = false;  // in the subspace of the last moves
  double residual_ = 0;   // before the last step [-]; infinite: no contact, or not a finite number
  double power_ = 0;      // sum of the last step's velocity times the residual before it
  double frequency_ = 0;  // sqrt of the Rayleigh quotient of the velocity [1 / step]
  double floor_ = tuned::first_floor;  // of the damping
  long steps_ = 0;
  long next_extrapolation_ = tuned::first_extrapolation;  // not before this step
  double pause_ = 0;                                      // after the last extrapolation [steps]
  double calm_start_ = 0, calm_max_ = 0;  // residual at the last look at the geometry, and since
  double look_max_ = 0, look_min_ = std::numeric_limits<double>::infinity();  // residual since then
  double window_start_ = std::numeric_limits<double>::infinity();
  double window_max_ = 0, window_min_ = std::numeric_limits<double>::infinity();
  double least_max_ = std::numeric_limits<double>::infinity();  // of the windows'
  long last_gain_ = 0;                                          // when it fell [steps]
};

// A Relaxation from rest, run once.
template <int D>
bool relax(Increment<D>& increment, double tolerance, long max_steps, History history,
           RelaxationMemory<D>& memory, double least_force = 0, bool may_extrapolate = true);

}  // namespace grainlaw::core

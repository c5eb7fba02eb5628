// Damped relaxation in pseudo-time towards equilibrium: unit steps, masses that follow the
// contacts.
#pragma once

#include "contact/contact_sides.hpp"
#include "equilibrium/subspace_extrapolation.hpp"
#include "increment/increment.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace grainlaw {

enum class History { committed, advancing };

// Memory of the relaxations, reused from call to call.
struct RelaxationMemory {
  std::vector<double> velocity, gain, mass, correction;
  ContactSides sides;
  SubspaceExtrapolation slow;
  // Of the servo: what the relaxations do not move, forces before reduction, areas and particles of
  // nodes under uniform stress.
  std::vector<unsigned char> frozen;
  std::vector<ForceRecord> raw;
  std::vector<std::array<double, 2>> area;
  std::vector<std::size_t> particle;
};

// Viscous relaxation: the damping follows the lowest active frequency, and its floor adapts to
// flutter. Where soft modes creep under it, the relaxation extrapolates along them.
class Relaxation {
 public:
  // At rest at the present coordinates. An extrapolation may end on another branch of equilibria.
  Relaxation(Increment& increment, History history, RelaxationMemory& memory,
             bool may_extrapolate = true);

  // Go on until residual_norm() < tolerance, at most `steps` further steps. Returns whether it got
  // there. Ends too when no more than `least_force` is left of the mean contact force [N], or when
  // friction keeps it fluttering. The coordinates may be changed between two calls.
  bool run(double tolerance, long steps, double least_force = 0);

 private:
  void refresh();
  void look();
  [[nodiscard]] bool calm() const;
  ContactSides::Measured step_nodes(double keep, double gain);
  void update();
  [[nodiscard]] double size() const;  // of the packing, over 400 nodes; 1 where there are fewer
  void review_floor();
  bool extrapolate();
  [[nodiscard]] bool flutters() const;
  void step();
  void step_deformation();

  Increment& increment_;
  History history_;
  RelaxationMemory& memory_;
  bool by_sides_ = false;      // forces and steps by ContactSides
  bool at_once_ = false;       // nothing comes between the sums of forces and the step
  bool arranged_ = false;      // of the contacts listed at present
  bool at_rest_ = true;        // no velocities to keep
  bool rough_ = false;         // friction, and forces a function of the places
  bool extrapolates_ = false;  // in the subspace of the last moves
  double residual_ = 0;   // before the last step [-]; infinite: no contact, or not a finite number
  double power_ = 0;      // sum of the last step's velocity times the residual before it
  double frequency_ = 0;  // sqrt of the Rayleigh quotient of the velocity [1 / step]
  static constexpr double first_floor = 0.1;
  double floor_ = first_floor;  // of the damping
  long steps_ = 0;
  static constexpr long first_extrapolation = 200;
  long next_extrapolation_ = first_extrapolation;  // not before this step
  double pause_ = 0;                               // after the last extrapolation [steps]
  double calm_start_ = 0, calm_max_ = 0;  // residual at the last look at the geometry, and since
  double look_max_ = 0, look_min_ = std::numeric_limits<double>::infinity();  // residual since then
  double window_start_ = std::numeric_limits<double>::infinity();
  double window_max_ = 0, window_min_ = std::numeric_limits<double>::infinity();
  double least_max_ = std::numeric_limits<double>::infinity();  // of the windows'
  long last_gain_ = 0;                                          // when it fell [steps]
};

struct PublishedOptions;

// A Relaxation from rest, run once.
bool relax(Increment& increment, double tolerance, long max_steps, History history,
           RelaxationMemory& memory, double least_force = 0, bool may_extrapolate = true);

// The papers' dynamic relaxation: physical masses, local damping -alpha |f| sign(v) (Liu, Bosco &
// Suiker 2017 eq. 10), explicit steps, history advanced at every step. Ends at the residual
// tolerance or, when energy_tolerance > 0, at Ek/Ep <= tolE (eq. 11) once Ek has fallen. `frozen`
// has the bits of Fixed of nodes that do not move (may be empty: all do, and F where it is found).
bool relax_published(Increment& increment, double tolerance, const PublishedOptions& options,
                     std::span<const unsigned char> frozen, RelaxationMemory& memory);

}  // namespace grainlaw

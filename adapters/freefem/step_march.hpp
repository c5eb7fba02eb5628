// The march of a set of points, options and position by name: what the plugin does, without FreeFEM.
#pragma once

#include "point_set.hpp"

#include <grainlaw/grainlaw.hpp>

#include <string>

namespace grainlaw_freefem {

// Every function throws std::exception with a text for the user.
class StepMarch {
 public:
  // The set has to outlive it.
  explicit StepMarch(grainlaw::Points& set) : set_(&set), march_(&set) {}

  // Options by the names of grainlaw_march_options; to be set between load steps.
  [[nodiscard]] static double default_option(const std::string& name);
  void set_option(const std::string& name, double value);

  void begin(double from, double to);
  grainlaw_action next() { return march_.next(); }
  // Where it stands, by the names of grainlaw_part.
  [[nodiscard]] double part(const std::string& name) const;
  [[nodiscard]] std::string message() const { return march_.part().message; }

  // The largest norm of changes of F, dim^2 numbers a point.
  [[nodiscard]] double largest(const Array& changes) const;
  // Share of a correction to apply that changes F by so much.
  double share(double largest) { return march_.share(largest); }
  void tell(double residual, double scale, double unforeseen);
  // Tells that points found no equilibrium, how much less they suggest, and why.
  void fail(double step_ratio, const std::string& reason);

 private:
  void check_turn(grainlaw_status status) const;

  grainlaw::Points* set_;
  grainlaw_march_options options_ = grainlaw_march_options_default();
  grainlaw::March march_;
};

}  // namespace grainlaw_freefem

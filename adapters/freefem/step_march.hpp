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

  // Share of a correction to apply, from the changes of F that it makes, dim^2 numbers a point.
  double share(const Array& changes);
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

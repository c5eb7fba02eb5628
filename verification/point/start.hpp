// What a packing is like before its path begins: what is unusual in it, and what a failure near the
// start says of it.
#pragma once

#include "app/material.hpp"
#include "point/path.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Whether contacts of the material hold in tension.
bool carries_tension(const MaterialSource& source);

struct PackingStart {
  int dimension = 2;
  int particles = 0;      // all copies of a frame
  double pressure = 0;    // mean, of the Cauchy stress at F = I [Pa]
  double stiffness = 0;   // kn / (pressure x thickness), of spheres x mean diameter, kn the mean of
                          // the contacts; Hertz-Mindlin: their secant; 0 without pressure [-]
  double void_ratio = 0;  // [-]
  double overlap = 0;     // mean, of the contacts' mean radius [-]
  std::vector<std::string> unusual;  // one text each

  // "mean pressure 1e+05 Pa, kn/p 300 [-], void ratio 0.2 [-]", and the same with
  // ", mean overlap 0.5 % of a radius; unusual: ..."
  [[nodiscard]] std::string brief() const;
  [[nodiscard]] std::string text() const;
};

// Of a state at its start. Throws ComputationError.
PackingStart look_at_start(const grainlaw_state* state, const MaterialSource& source);

// What of a path goes far from where the packing starts, one text each.
std::vector<std::string> far_targets(const PackingStart& start, const std::vector<Segment>& path);

// Tells what is unusual on stderr.
void warn(const std::string& name, const PackingStart& start);
// One line on stdout, "NAME: starts at mean pressure ...", and what is unusual.
void tell_start(const std::string& name, const PackingStart& start);

// What a failure in one of the first steps may come of, and what to try; "" after them.
std::string why_at_start(const PackingStart& start, int steps_done, const std::string& to_try);
// For a path: smaller steps, when these are large for contacts so stiff.
std::string smaller_steps(const PackingStart& start, const Segment& segment);

}  // namespace verification

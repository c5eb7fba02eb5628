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
  bool drag = false;      // a law in time
  std::vector<std::string> unusual;  // one text each

  // "mean pressure 1e+05 Pa, kn/p 300 [-], void ratio 0.2 [-]", and the same with
  // ", mean overlap 0.5 % of a radius; unusual: ..."
  [[nodiscard]] std::string brief() const;
  [[nodiscard]] std::string text() const;
};

// Of a state at its start. Writes and removes files that begin with `stem`. Throws ComputationError.
PackingStart look_at_start(const grainlaw_state* state, const MaterialSource& source,
                           const std::filesystem::path& stem);

// What of a path goes far from where the packing starts, one text each.
std::vector<std::string> far_targets(const PackingStart& start, const std::vector<Segment>& path);

// Tells what is unusual on stderr.
void warn(const std::string& name, const PackingStart& start);
// One line on stdout, "NAME: starts at mean pressure ...", and what is unusual.
void tell_start(const std::string& name, const PackingStart& start);

// Whether kn/p is out of the usual range, as a text, else "".
std::string unusual_stiffness(double stiffness);

// What a failure in one of the first steps may come of; "" after them.
std::string why_at_start(const PackingStart& start, int steps_done);
// What to try after a load step of a body failed.
std::string load_advice(const PackingStart& start, int steps_done);
// What to try after a step of a path failed at this Cauchy stress, components row by row [Pa].
std::string path_advice(const PackingStart& start, int steps_done, grainlaw_status status,
                        const Segment& segment, const Eigen::VectorXd& cauchy);

}  // namespace verification

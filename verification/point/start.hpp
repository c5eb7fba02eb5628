// State of a packing before its path: unusual values, and causes of failures near the start.
#pragma once

#include "app/material.hpp"
#include "point/path.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Whether contacts of the material bear tension.
bool bears_tension(const MaterialSource& source);

struct PackingStart {
  int dimension = 2;
  int particles = 0;      // including copies of a frame
  double pressure = 0;    // mean pressure of the Cauchy stress at F = I [Pa]
  double stiffness = 0;   // kn / (pressure x thickness), of spheres x mean diameter, with kn the
                          // contacts' mean, secant of Hertz-Mindlin; 0 without pressure [-]
  double void_ratio = 0;  // [-]
  double overlap = 0;     // mean overlap over the contacts' mean radius [-]
  bool drag = false;      // a law in time
  std::vector<std::string> unusual;  // one text each

  // brief(): "mean pressure 1e+05 Pa, kn/p 300 [-], void ratio 0.2 [-]". The full text adds ", mean
  // overlap 0.5 % of a radius; unusual: ...".
  [[nodiscard]] std::string brief() const;
  [[nodiscard]] std::string text() const;
};

// Measures of a state at its start. Throws ComputationError.
PackingStart measure_start(const grainlaw_state* state, const MaterialSource& source);

// Targets of a path that lie far from the start of the packing, one text each.
std::vector<std::string> far_targets(const PackingStart& start, const std::vector<Segment>& path);

// Prints unusual values to stderr.
void warn(const std::string& name, const PackingStart& start);
// Prints one line, "NAME: starts at mean pressure ...", and unusual values to stdout.
void print_start(const std::string& name, const PackingStart& start);

// Tells kn/p out of the usual range; "" within it.
std::string unusual_stiffness(double stiffness);

// Probable cause of a failure in one of the first steps; "" after them.
std::string why_at_start(const PackingStart& start, int steps_done);
// Cure after a load step of a body failed; `status`: of the point that refused it, else OK.
std::string load_advice(const PackingStart& start, int steps_done, grainlaw_status status);
// Cure after a step of a path failed at this Cauchy stress, components row by row [Pa].
std::string path_advice(const PackingStart& start, int steps_done, grainlaw_status status,
                        const Segment& segment, const Eigen::VectorXd& cauchy);

}  // namespace verification

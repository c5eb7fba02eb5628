// Packings and materials of the study, in one place: the law in time, and equilibrium beside it.
#pragma once

#include "evidence/studies/study.hpp"

#include "app/scratch.hpp"

#include <map>
#include <string>
#include <vector>

namespace verification::drag {

inline constexpr double pressure = -drained_pressure;  // of every packing at F = I [Pa]

struct Packing {
  int dimension = 2;
  int count = 400;
  long seed = 1;
  double young = 6e8;                    // [Pa]
  double friction = 0.5463024898437905;  // [-]
  std::string file = {};  // prefix in tests/data instead of a generated packing: "rve400"
  int repeat = 0;         // its contacts nudged() that many times

  [[nodiscard]] std::string name() const;
};

// 400 discs of the recipe of scenes/pack400.toml, kn / (p t) = 300; 200 spheres of young 1e8.
std::vector<Packing> discs(int packings, int count = 400);
std::vector<Packing> spheres(int packings, int count = 200);

// kn / (p t) of discs, kn / (p R) of spheres, by the mean radius [-].
double stiffness_ratio(const Packing& packing);
// The Young's modulus for it [Pa].
double young_of(int dimension, double stiffness_ratio);

struct Setting {
  bool in_time = true;  // false: equilibrium
  double share = 1;     // of the study's viscous_number
  double rate = 0;      // solver.viscous_rate, 0: strain is the time [1/s]
  int parts = 1;        // solver.viscous_steps
  double tolerance = 1e-8;
  bool from_trial = false;   // solver.start
  bool stress_free = false;  // solver.contacts_lost
};
inline constexpr Setting equilibrium{.in_time = false};

// Makes materials of the study. Generated packings are made once.
class Materials {
 public:
  // `number`: solver.viscous_number, 0: not given. `keys`: further lines of [solver].
  Materials(const StudyOptions& options, double number, std::vector<std::string> keys);

  Material operator()(const Packing& packing, const Setting& setting);
  // A material at equilibrium of the packing that this state is at.
  Material at_rest(const State& state, const Packing& packing);

  [[nodiscard]] double number() const { return number_; }
  [[nodiscard]] const StudyOptions& options() const { return options_; }

 private:
  std::string prefix_of(const Packing& packing);
  [[nodiscard]] Material read(const std::string& prefix, const Packing& packing,
                              const Setting& setting) const;

  StudyOptions options_;
  double number_;
  std::vector<std::string> keys_;
  ScratchDirectory scratch_;
  std::map<std::string, std::string> made_;  // prefixes of files by what they were made from
};

}  // namespace verification::drag

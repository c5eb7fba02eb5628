// Servo against direct for every figure: steps, time, and distance in P.

#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace verification {
namespace {

struct CaseCost {
  double particles = 0, steps = 0, relaxation_steps = 0, corrections = 0, factorisations = 0;
  double cpu = 0;  // [s]
};

// By case name, from SCENE_cases.csv.
std::map<std::string, CaseCost> read_costs(const std::filesystem::path& path) {
  std::map<std::string, CaseCost> costs;
  if (!std::filesystem::is_regular_file(path)) return costs;
  const CsvTable table = read_csv(path);
  const std::vector<std::string> names = read_csv_names(path);
  for (std::size_t k = 0; k < names.size(); ++k)
    costs[names[k]] = {table["particles"][k],        table["steps"][k],
                       table["relaxation_steps"][k], table["servo_corrections"][k],
                       table["factorisations"][k],   table["cpu"][k]};
  return costs;
}

// Largest |P_a - P_b| / |P_b| over the common steps after the start [-].
double distance(const PaperRun& a, const PaperRun& b) {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 1; k < std::min(a.steps(), b.steps()); ++k) {
    double difference = 0, size = 0;
    for (const char* component : {"P11", "P12", "P21", "P22"}) {
      const double p = a.history[component][k], q = b.history[component][k];
      difference += (p - q) * (p - q);
      size += q * q;
    }
    largest = std::fmax(largest, std::sqrt(difference / size));
  }
  return largest;
}

// Extreme values over the runs of one kind.
struct Kind {
  double least_steps = INFINITY, most_steps = 0, least_cpu = INFINITY, most_cpu = 0;
  double distance = 0, same_relaxation = 0;  // largest

  void add(double steps, double cpu, double direct, double relaxed) {
    least_steps = std::fmin(least_steps, steps), most_steps = std::fmax(most_steps, steps);
    least_cpu = std::fmin(least_cpu, cpu), most_cpu = std::fmax(most_cpu, cpu);
    // NaN, where there was nothing to compare, stays.
    distance = std::isnan(distance) || direct <= distance ? distance : direct;
    same_relaxation =
        std::isnan(same_relaxation) || relaxed <= same_relaxation ? same_relaxation : relaxed;
  }
};

struct Kinds {
  Kind lattices, irregular, layer;

  void add_to(Facts& facts) const {
    for (const auto& [name, kind] :
         {std::pair{"lattices", &lattices}, {"irregular", &irregular}, {"layer", &layer}}) {
      if (kind->most_steps == 0) continue;
      facts.add(fmt::format("servo.{}.least_steps_over_direct", name), kind->least_steps);
      facts.add(fmt::format("servo.{}.least_cpu_over_direct", name), kind->least_cpu);
      facts.add(fmt::format("servo.{}.distance_default", name), kind->distance);
      facts.add(fmt::format("servo.{}.distance_same_relaxation", name), kind->same_relaxation);
    }
  }
};

}  // namespace

// Cases come in threes, WHAT_servo, WHAT_relaxed and WHAT_direct: the published servo, the frame
// relaxed at once by the servo's own relaxation, and the default. Figure 2 is whole, without the
// second.
void study_servo_cost(PaperStudy& study) {
  Table table("Servo against direct",
              {"figure", "particles[-]", "increment[-]", "increments[-]", "servo_steps[-]",
               "corrections[-]", "servo_cpu[s]", "direct_steps[-]", "factorisations[-]",
               "direct_cpu[s]", "steps_servo_over_direct[-]", "cpu_servo_over_direct[-]",
               "distance_direct[-]", "distance_same_relaxation[-]"});
  struct Group {
    const char* scene;
    const char* figure;
    const char* servo;  // how the name of a servo's case ends
  };
  int rows = 0;
  Kinds groups;
  for (const Group& group : {Group{"figure_02", "2", "_predicted"},
                             {"servo_regular", "4 and 5", "_servo"},
                             {"servo_irregular", "7 to 10", "_servo"},
                             {"servo_layer", "11 and 12", "_servo"}}) {
    const auto costs = read_costs(study.results / (std::string(group.scene) + "_cases.csv"));
    const std::string ending = group.servo;
    for (const auto& [name, servo] : costs) {
      if (!name.ends_with(ending)) continue;
      const std::string what = name.substr(0, name.size() - ending.size());
      const auto found = costs.find(what + "_direct");
      const auto servo_run = study.run(name), direct_run = study.run(what + "_direct"),
                 relaxed_run = study.run(what + "_relaxed");
      if (found == costs.end() || !servo_run || !direct_run) continue;
      const CaseCost& direct = found->second;
      const double none = std::numeric_limits<double>::quiet_NaN();
      const bool same_range = servo.steps == direct.steps;
      double increment = none;
      for (const char* component : {"F11", "F12", "F21", "F22"})
        if (direct_run->steps() > 1)
          increment = std::fmax(increment, std::abs(direct_run->history[component][1] -
                                                    direct_run->history[component][0]));
      table.row({"fig. " + std::string(group.figure) + ": " +
                     what.substr(std::string(group.scene).size() + 1),
                 servo.particles, increment, servo.steps, servo.relaxation_steps, servo.corrections,
                 servo.cpu, direct.relaxation_steps, direct.factorisations, direct.cpu,
                 same_range ? servo.relaxation_steps / direct.relaxation_steps : none,
                 same_range ? servo.cpu / direct.cpu : none, distance(*direct_run, *servo_run),
                 relaxed_run ? distance(*relaxed_run, *servo_run) : none});
      ++rows;
      if (!same_range) continue;
      const bool layer = std::string(group.scene) == "servo_layer";
      const bool irregular = std::string(group.scene) == "servo_irregular";
      if (std::string(group.scene) == "figure_02") continue;  // whole, over several branches
      (layer       ? groups.layer
       : irregular ? groups.irregular
                   : groups.lattices)
          .add(servo.relaxation_steps / direct.relaxation_steps, servo.cpu / direct.cpu,
               distance(*direct_run, *servo_run),
               relaxed_run ? distance(*relaxed_run, *servo_run) : none);
    }
  }
  if (rows == 0) return;
  table.print();
  table.write(study.results / "servo_cost.csv");
  groups.add_to(study.facts);
}

}  // namespace verification

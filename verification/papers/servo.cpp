// Servo against direct for every figure: steps, time, and distance in P.

#include "papers/papers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
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
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  for (std::size_t k = 0; std::getline(file, line); ++k)
    costs[line.substr(0, line.find(','))] = {
        table["particles"][k],         table["steps"][k],          table["relaxation_steps"][k],
        table["servo_corrections"][k], table["factorisations"][k], table["cpu"][k]};
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

}  // namespace

// Cases come in threes, WHAT_servo, WHAT_relaxed and WHAT_direct: the published servo, the frame
// relaxed at once by the servo's own relaxation, and the default.
void study_servo_cost(PaperStudy& study) {
  Table table("Servo against direct",
              {"figure", "particles[-]", "increment[-]", "increments[-]", "servo_steps[-]",
               "corrections[-]", "servo_cpu[s]", "direct_steps[-]", "factorisations[-]",
               "direct_cpu[s]", "steps_servo_over_direct[-]", "cpu_servo_over_direct[-]",
               "distance_direct[-]", "distance_same_relaxation[-]"});
  double least_ratio = std::numeric_limits<double>::infinity(), largest_distance = 0;
  int rows = 0;
  for (const char* scene : {"servo_regular", "servo_irregular", "servo_layer"}) {
    const auto costs = read_costs(study.results / (std::string(scene) + "_cases.csv"));
    for (const auto& [name, servo] : costs) {
      const std::size_t at = name.rfind("_servo");
      if (at == std::string::npos || at + 6 != name.size()) continue;
      const std::string what = name.substr(0, at);
      const auto found = costs.find(what + "_direct");
      const auto servo_run = study.run(name), direct_run = study.run(what + "_direct"),
                 relaxed_run = study.run(what + "_relaxed");
      if (found == costs.end() || !servo_run || !direct_run) continue;
      const CaseCost& direct = found->second;
      const double none = std::numeric_limits<double>::quiet_NaN();
      const double ratio = servo.relaxation_steps / direct.relaxation_steps;
      const double apart = relaxed_run ? distance(*relaxed_run, *servo_run) : none;
      double increment = 0;
      for (const char* component : {"F11", "F12", "F21", "F22"})
        if (servo_run->steps() > 1)
          increment = std::max(increment, std::abs(servo_run->history[component][1] -
                                                   servo_run->history[component][0]));
      table.row({what.substr(std::string(scene).size() + 1), servo.particles, increment,
                 servo.steps, servo.relaxation_steps, servo.corrections, servo.cpu,
                 direct.relaxation_steps, direct.factorisations, direct.cpu, ratio,
                 servo.cpu / direct.cpu, distance(*direct_run, *servo_run), apart});
      least_ratio = std::min(least_ratio, ratio);
      largest_distance = std::fmax(largest_distance, apart);
      ++rows;
    }
  }
  if (rows == 0) return;
  table.print();
  table.write(study.results / "servo_cost.csv");
}

}  // namespace verification

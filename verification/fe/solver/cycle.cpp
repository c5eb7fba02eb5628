#include "fe/solver/cycle.hpp"

#include "fe/conditions/monitors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

constexpr int most_corrections = 8;  // of a step beyond the limit
constexpr double shortest = 0.02;    // least factor of a correction

}  // namespace

Cycle read_cycle(SceneTable table, Model& model) {
  Cycle cycle;
  const std::string set = table.text("on");
  if (!model.mesh.node_sets.contains(set)) {
    std::string known;
    for (const auto& entry : model.mesh.node_sets)
      known += (known.empty() ? "" : ", ") + entry.first;
    table.fail("on", '"' + set + '"', "one of " + known);
  }
  const std::string component =
      table.choice_or("component", "x", component_names(model.mesh.dimension()));
  cycle.drive = set + '_' + component;
  cycle.step = table.number("step", positive);
  const double never = cycle.limit_force;
  cycle.limit_displacement = table.number_or("limit_displacement", never, positive);
  cycle.limit_force = table.number_or("limit_force", never, positive);
  if (cycle.limit_displacement == never && cycle.limit_force == never)
    table.fail("limit_displacement", "nothing", "limit_displacement or limit_force");
  cycle.tolerance = table.number_or("tolerance", cycle.tolerance, positive);
  cycle.cycles = table.integer("cycles", 1);
  cycle.end_displacement = table.number_or("end_displacement", never, positive);
  cycle.end_mean_stress = table.number_or("end_mean_stress", 0, not_negative);
  table.close();
  cycle.segment = std::make_shared<LinearSegment>();
  PrescribedDisplacement drive;
  drive.nodes = model.mesh.node_sets.at(set);
  drive.component = component[0] - 'x';
  drive.name = cycle.drive;
  drive.set = set;
  drive.place = table.place();
  drive.value.steered = cycle.segment;
  model.displacements.push_back(drive);
  return cycle;
}

CycleControl::CycleControl(const Cycle& cycle, const Model& model, double time_step)
    : cycle_(cycle), time_step_(time_step) {
  const auto monitors = make_monitors(model);
  const auto drive = std::find_if(monitors.begin(), monitors.end(), [&](const Monitor& monitor) {
    return monitor.name == cycle_.drive;
  });
  monitor_ = static_cast<std::size_t>(drive - monitors.begin());
}

LoadStep CycleControl::advance(Solver& solver, int number) {
  if (number == 0) return solver.advance(0, 0);
  CheckpointWriter start;
  if (std::isfinite(cycle_.limit_force)) solver.save(start);
  double goal = target();
  Effort taken_back;
  for (int correction = 0;; ++correction) {
    const double part = std::abs(goal - displacement_) / cycle_.step;
    const double next = time_ + part * time_step_;
    *cycle_.segment = {time_, displacement_, next, goal};
    LoadStep step = solver.advance(next, number);
    const double force = direction_ * step.reactions[monitor_];
    const double before = direction_ * force_;
    const double excess = force - cycle_.limit_force;
    if (excess > cycle_.tolerance * cycle_.limit_force && before < cycle_.limit_force &&
        correction < most_corrections) {
      const double ratio = (cycle_.limit_force - before) / (force - before);
      goal = displacement_ + std::max(shortest, ratio) * (goal - displacement_);
      taken_back.add(step.record.effort);
      CheckpointReader in(start.bytes(), "a step taken back");
      *cycle_.segment = {time_, displacement_, time_, displacement_};
      solver.restore(in);
      continue;
    }
    step.record.effort.add(taken_back);
    time_ = next;
    displacement_ = goal;
    look(step.reactions[monitor_], step.record.mean_pressure());
    return step;
  }
}

double CycleControl::target() const {
  constexpr double rounding = 1e-9;  // rounding of summed steps, over a step
  const double goal = displacement_ + direction_ * cycle_.step;
  const auto up_to = [&](double end) {
    return direction_ * (end - goal) < rounding * cycle_.step ? end : goal;
  };
  // The last half cycle ends at zero; displacements reverse at their limit.
  const bool last_way = reversals_ >= 2 * cycle_.cycles;
  if (last_way && std::isinf(cycle_.limit_force) && displacement_ < 0) return up_to(0);
  return up_to(direction_ * cycle_.limit_displacement);
}

// Reverses or ends at the limits.
void CycleControl::look(double force, double mean_stress) {
  force_ = force;
  const bool last_way = reversals_ >= 2 * cycle_.cycles;
  const double controlled = std::isinf(cycle_.limit_force) ? displacement_ : force_;
  if ((last_way && direction_ * controlled >= 0) ||
      std::abs(displacement_) >= cycle_.end_displacement ||
      (cycle_.end_mean_stress > 0 && mean_stress < cycle_.end_mean_stress))
    finished_ = true;
  if (direction_ * displacement_ < cycle_.limit_displacement &&
      direction_ * force_ < (1 - cycle_.tolerance) * cycle_.limit_force)
    return;
  direction_ = -direction_;
  ++reversals_;
}

void run_cycles(CycleControl& control, Solver& solver, int steps, const LoadObserver& observe,
                int first) {
  for (int step = first; step <= steps && !control.finished(); ++step)
    observe(control.advance(solver, step), solver);
}

void CycleControl::save(CheckpointWriter& out) const {
  for (const double value : {time_, displacement_, force_, direction_}) out.write(value);
  out.write(reversals_);
  out.write(finished_);
}

void CycleControl::restore(CheckpointReader& in) {
  for (double* value : {&time_, &displacement_, &force_, &direction_}) in.read(*value);
  in.read(reversals_);
  in.read(finished_);
  *cycle_.segment = {time_, displacement_, time_, displacement_};
}

}  // namespace verification

#include "fe/output/run_output.hpp"

#include "app/history.hpp"
#include "fe/conditions/monitors.hpp"

#include <fmt/format.h>

namespace verification {
namespace {

std::vector<std::string> force_columns(const Model& model) {
  std::vector<std::string> columns{"step[-]"};
  for (const Monitor& monitor : make_monitors(model)) {
    columns.push_back(monitor.name + "_displacement[m]");
    columns.push_back(monitor.name + "_force[N/m]");
  }
  return columns;
}

}  // namespace

RunOutput::RunOutput(const FiniteElementScene& scene, RunTables tables, const Solver& solver)
    : scene_(scene),
      solver_(solver),
      tables_(std::move(tables)),
      history_(tables_.open(".csv", record_columns())),
      newton_(tables_.open("_newton.csv",
                           {"step[-]", "iteration[-]", "relative_residual[-]"})),
      forces_(tables_.open("_force.csv", force_columns(scene.model))) {}

void RunOutput::add(const LoadStep& step) {
  const int number = step.record.step;
  history_.row(record_values(step.record));
  for (std::size_t k = 0; k < step.residuals.size(); ++k)
    newton_.row({static_cast<double>(number), static_cast<double>(k), step.residuals[k]});
  std::vector<double> forces{static_cast<double>(number)};
  for (std::size_t k = 0; k < step.reactions.size(); ++k) {
    forces.push_back(step.displacements[k]);
    forces.push_back(step.reactions[k]);
  }
  forces_.row(forces);
  if (scene_.vtk_every > 0 && number % scene_.vtk_every == 0)
    write_vtk(solver_.points().state(0), tables_.stem(), number);
}

void RunOutput::save(CheckpointWriter&) const {}
void RunOutput::restore(CheckpointReader&) {}

void RunOutput::finish() const {
  draw_history(read_csv(history_.path()), scene_.abscissa, scene_.name, tables_.stem());
}

std::string RunOutput::history() const { return history_summary(read_csv(history_.path())); }

std::string RunOutput::written() const {
  return fmt::format("{}.csv, _newton.csv, _force.csv, .svg, .png", tables_.stem().string());
}

}  // namespace verification

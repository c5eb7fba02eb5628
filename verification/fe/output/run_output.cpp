#include "fe/output/run_output.hpp"

#include "app/history.hpp"
#include "app/load_figure.hpp"
#include "app/snapshot.hpp"
#include "fe/conditions/monitors.hpp"
#include "fe/output/balance.hpp"
#include "fe/output/energy.hpp"
#include "fe/output/mesh_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace verification {
namespace {

std::vector<std::string> force_columns(const Model& model) {
  std::vector<std::string> names{"step[-]"};
  for (const Monitor& monitor : make_monitors(model))
    for (const std::string& name : columns(monitor, model.mesh.dimension())) names.push_back(name);
  return names;
}

// Driving conditions: prescribed displacements, and platens under a load.
std::vector<std::string> leading_conditions(const Model& model) {
  std::vector<std::string> names;
  for (const PrescribedDisplacement& condition : model.displacements)
    names.push_back(condition.name);
  for (const Monitor& monitor : make_monitors(model))
    if (monitor.resultant >= 0) names.push_back(monitor.name);
  return names;
}

std::vector<std::string> point_columns(int dimension) {
  std::vector<std::string> names{"step[-]", "time[s]"};
  for (const std::string_view axis : component_names(dimension))
    names.push_back(fmt::format("{}[m]", axis));
  for (const Field& field : fields(dimension))
    for (const std::string& name : columns(field)) names.push_back(name);
  return names;
}

}  // namespace

Outputs outputs_of(const FiniteElementScene& scene, bool goes_on) {
  Outputs outputs;
  const std::string& name = scene.name;
  const OutputOptions& output = scene.output;
  const auto add = [&](std::initializer_list<const char*> ends) { outputs.add(name, name, ends); };
  if (!goes_on) {
    add({".checkpoint", ".csv", "_newton.csv", "_force.csv", "_cost.csv"});
    add({scene.solver.kind == SolverKind::dynamics ? "_energy.csv" : "_balance.csv"});
    if (!scene.probes.empty()) add({"_probes.csv"});
    for (const std::size_t point : output.points)
      outputs.add(name, fmt::format("{}_point{}", name, point), {".csv"});
    for (const std::string& field : output.every_point)
      outputs.add(name, name + "_every_" + field, {".csv"});
    if (output.point_costs) add({"_every_cost.csv"});
  }
  if (!scene.prestress.empty()) outputs.add_packing(name, name + "_prestress");
  outputs.add_pictures(name, name);
  outputs.add_pictures(name, name + "_force");
  const auto add_drawn = [&](const std::string& what) {
    for (const char* end : {".svg", ".png"}) outputs.add_series(name, name + "_", what + end);
  };
  for (const std::string& field : output.pictures.fields) add_drawn("_" + field);
  if (!output.pictures.packings.empty() || !output.pictures.extremes.empty())
    add_drawn("_packings");
  if (output.vtk_every == 0) return outputs;
  add({"_mesh.pvd", "_points.pvd"});
  outputs.add_series(name, name + "_mesh_", ".vtu");
  outputs.add_series(name, name + "_points_", ".vtp");
  for (const std::size_t point : output.packings) {
    const std::string packing = fmt::format("{}_packing{}", name, point);
    outputs.add(name, packing, {".pvd"});
    outputs.add_series(name, packing + "_", ".vtp");
  }
  return outputs;
}

// Opens a table; tables of a kind are printed under one name.
CsvWriter& RunOutput::open(const std::string& suffix, const std::vector<std::string>& columns,
                           const char* shown) {
  CsvWriter& table = tables_.open(suffix, columns);
  written_.add(shown != nullptr ? shown : suffix);
  return table;
}

RunOutput::RunOutput(const FiniteElementScene& scene, RunTables tables, const Solver& solver)
    : scene_(scene),
      solver_(solver),
      tables_(std::move(tables)),
      written_(tables_.stem()),
      drag_(has_drag(scene.material)),
      history_(open(".csv", in_dimension(scene.dimension,
                                         [&]<int D>() { return record_columns<D>(drag_); }))),
      newton_(open("_newton.csv", {"step[-]", "iteration[-]", "relative_residual[-]"})),
      forces_(open("_force.csv", force_columns(scene.model))),
      costs_(open("_cost.csv", cost_columns())),
      cost_(solver, scene.output.point_costs
                        ? &open("_every_cost.csv", point_cost_columns(solver.points().size()),
                                "_every_FIELD.csv")
                        : nullptr),
      series_(scene.model, tables_.stem(), scene.output.packings) {
  if (scene.solver.kind == SolverKind::dynamics)
    energies_ = &open("_energy.csv", energy_columns(scene.dimension));
  else
    balance_ = &open("_balance.csv", balance_columns());
  if (!scene.probes.empty())
    probes_ = &open("_probes.csv", probe_columns(scene.probes, scene.dimension));
  for (const std::size_t point : scene.output.points)
    points_.push_back(
        &open(fmt::format("_point{}.csv", point), point_columns(scene.dimension), "_pointN.csv"));
  for (const std::string& name : scene.output.every_point) {
    std::vector<std::string> columns{"step[-]"};
    for (std::size_t p = 0; p < solver.points().size(); ++p)
      columns.push_back(fmt::format("point{}[{}]", p, field(name, scene.dimension).unit));
    every_point_.push_back(&open(fmt::format("_every_{}.csv", name), columns, "_every_FIELD.csv"));
  }
}

void RunOutput::add(const LoadStep& step, bool ends_before) {
  {
    const auto measure = solver_.points().cost().measure(Stage::output);
    write(step, ends_before);
  }
  cost_.add(step, costs_);
}

void RunOutput::write(const LoadStep& step, bool ends_before) {
  const int number = step.record.step;
  history_.row(step.record.values(drag_));
  for (std::size_t k = 0; k < step.residuals.size(); ++k)
    newton_.row({static_cast<double>(number), static_cast<double>(k), step.residuals[k]});
  std::vector<double> forces{static_cast<double>(number)};
  for (std::size_t k = 0; k < step.reactions.size(); ++k) {
    forces.push_back(step.displacements[k]);
    forces.push_back(step.reactions[k]);
  }
  forces_.row(forces);
  if (energies_ != nullptr) energies_->row(energy_values(step));
  if (balance_ != nullptr) balance_->row(balance_values(step));
  if (probes_ != nullptr)
    probes_->row(probe_values(scene_.probes, scene_.model.mesh, step, solver_.displacement()));
  const OutputOptions& output = scene_.output;
  for (std::size_t k = 0; k < points_.size(); ++k) add_point(output.points[k], step, *points_[k]);
  for (std::size_t k = 0; k < every_point_.size(); ++k) {
    std::vector<double> row =
        values(field(output.every_point[k], scene_.dimension), solver_.points());
    row.insert(row.begin(), static_cast<double>(number));
    every_point_[k]->row(row);
  }
  if (output.vtk_every > 0 && number % output.vtk_every == 0) {
    series_.add(step, solver_);
    for (const char* end : {"_mesh.pvd", "_points.pvd"}) written_.add(end);
    if (!output.packings.empty()) written_.add("_packingN.pvd");
  }
  const std::vector<int>& drawn = output.pictures.steps;
  if (ends_before || std::find(drawn.begin(), drawn.end(), number) != drawn.end()) draw(step);
}

void RunOutput::add_point(std::size_t point, const LoadStep& step, CsvWriter& table) const {
  const PointField& points = solver_.points();
  const Position position =
      current_position(scene_.model.mesh, points, point, solver_.displacement());
  std::vector<double> row{static_cast<double>(step.record.step), step.time};
  row.insert(row.end(), position.begin(), position.end());
  for (const Field& field : fields(scene_.dimension)) {
    std::array<double, 9> value{};
    field.value(point_view(points, point), value.data());
    row.insert(row.end(), value.begin(), value.begin() + field.components);
  }
  table.row(row);
}

void RunOutput::draw(const LoadStep& step) {
  const PointField& points = solver_.points();
  const std::string stem = fmt::format("{}_{:04d}", tables_.stem().string(), step.record.step);
  const std::string title = fmt::format("load step {}", step.record.step);
  for (const std::string& name : scene_.output.pictures.fields)
    if (draw_mesh({mesh_panel(scene_.model.mesh, points, solver_.displacement(),
                              field(name, scene_.dimension))},
                  title, stem + "_" + name))
      written_.add("_STEP_FIELD.svg");
  std::vector<SnapshotPanel> packings;
  for (const std::size_t point : scene_.output.pictures.packings)
    packings.push_back({fmt::format("point {}", point), take_snapshot(points.state(point))});
  for (const std::string& name : scene_.output.pictures.extremes) {
    const Field& shown = field(name, scene_.dimension);
    const std::vector<double> all = values(shown, points);
    const auto [least, largest] = std::minmax_element(all.begin(), all.end());
    for (const auto& [end, word] : {std::pair{least, "min"}, std::pair{largest, "max"}}) {
      const auto point = static_cast<std::size_t>(end - all.begin());
      const double value = *end * shown.picture_factor() + 0.0;  // no -0
      packings.push_back({fmt::format("{} {}:\n{:.3g} [{}], point {}", word, shown.label, value,
                                      shown.picture_unit(), point),
                          take_snapshot(points.state(point))});
    }
  }
  if (!packings.empty() && draw_snapshots(packings, 0, title, stem + "_packings"))
    written_.add("_STEP_packings.svg");
}

void RunOutput::add_unfinished(int step, const Effort& effort) {
  cost_.add_unfinished(step, effort, costs_);
}

void RunOutput::finish() {
  written_.add_pictures(draw_history(read_csv(history_.path()), scene_.abscissa, tables_.stem()));
  if (draw_load_figure(read_csv(forces_.path()), leading_conditions(scene_.model),
                       force_unit(scene_.dimension), tables_.stem().string() + "_force"))
    written_.add("_force.svg");
}

std::string RunOutput::summary(const Effort& unfinished) const {
  return history_summary(read_csv(history_.path()), unfinished) + "\n" +
         (balance_ == nullptr ? "" : balance_summary(read_csv(balance_->path()))) +
         cost_summary(read_csv(costs_.path()), solver_.points().size());
}

}  // namespace verification

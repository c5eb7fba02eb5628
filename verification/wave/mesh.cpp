// Meshes of a wave run: one row of elements with one point each, as in the thesis.

#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "fe/solver/dynamics.hpp"
#include "wave/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

Model make_model(const WaveCase& one, const WaveDomain& domain, int divisions) {
  Model model;
  model.mesh = box_mesh({domain.length, domain.height}, {divisions, 1}, ElementKind::q4r);
  const auto& sets = model.mesh.node_sets;
  const auto prescribe = [&](const char* set, int component, const Program& value) {
    model.displacements.push_back(
        {sets.at(set), component, value, fmt::format("{}_{}", set, component == 0 ? "x" : "y")});
  };
  const Program none = Program::linear(0, 0, one.duration);
  Program pulse = none;
  pulse.sine = {-one.pulse.amplitude, one.pulse.period, 0, 0.5};
  prescribe("left", 0, none);
  prescribe("bottom", 1, none);
  prescribe("top", 1, none);
  prescribe("right", 0, pulse);
  return model;
}

// Gauges of a mesh; nodes of bottom and top are paired, from left to right.
class MeshGauges {
 public:
  MeshGauges(const WaveCase& one, const WaveDomain& domain, const Mesh& mesh)
      : one_(&one), domain_(&domain), mesh_(&mesh) {
    for (const double distance : one.sections)
      if (distance > domain.length)
        throw InputError(
            fmt::format("{}: sections: found {} m, expected at most the length of {} m", one.name,
                        distance, domain.length));
    for (const auto& [from, to] : one.windows)
      if (to > domain.length)
        throw InputError(
            fmt::format("{}: window.to: found {} m, expected at most the length of {} m", one.name,
                        to, domain.length));
  }

  void read(const Solver& solver, WaveRow& row) const {
    for (const double distance : one_->sections)
      row.displacement.push_back(-displacement_at(domain_->length - distance, solver));
    for (const auto& [from, to] : one_->windows)
      row.stress.push_back(stress_in(domain_->length - to, domain_->length - from, solver));
  }

 private:
  [[nodiscard]] double displacement_at(double x, const Solver& solver) const {
    const auto& bottom = mesh_->node_sets.at("bottom");
    const auto& top = mesh_->node_sets.at("top");
    const auto value = [&](std::size_t k) {
      return 0.5 * (solver.displacement()[2 * bottom[k]] + solver.displacement()[2 * top[k]]);
    };
    const auto elements = static_cast<double>(bottom.size() - 1);
    const double position = std::clamp(x / domain_->length * elements, 0.0, elements);
    const auto k = std::min(static_cast<std::size_t>(position), bottom.size() - 2);
    const double share = position - static_cast<double>(k);
    return (1 - share) * value(k) + share * value(k + 1);
  }

  // Mean P22 of the elements, weighted by their part in the window.
  [[nodiscard]] double stress_in(double from, double to, const Solver& solver) const {
    const PointField& points = solver.points();
    double sum = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto corners = mesh_->positions(mesh_->elements[p]);
      double low = corners[0].x(), high = low;
      for (const auto& corner : corners) {
        low = std::min(low, corner.x());
        high = std::max(high, corner.x());
      }
      sum += std::max(std::min(high, to) - std::max(low, from), 0.0) * points.stress(p)(1, 1);
    }
    return sum / (to - from);
  }

  const WaveCase* one_;
  const WaveDomain* domain_;
  const Mesh* mesh_;
};

// Kinetic energy of the fluctuations in one volume, mean of all [J].
double mean_kinetic_energy(const PointField& points) {
  double sum = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    sum += measure_scalar(points.state(p), GRAINLAW_KINETIC_ENERGY);
  return sum / static_cast<double>(points.size());
}

}  // namespace

WaveRun run_mesh(const WaveCase& one, const WaveDomain& domain, int divisions) {
  const Model model = make_model(one, domain, divisions);
  const MeshGauges gauges(one, domain, model.mesh);
  const Material material = make_material(one.material);
  WaveRun run;
  run.name = fmt::format("{}", divisions);
  run.points = model.mesh.elements.size();
  run.particles = run.points * domain.particles;
  const int finest = *std::max_element(one.divisions.begin(), one.divisions.end());
  const double row_time = one.duration / static_cast<double>(one.rows);
  const double longest = one.mesh_time_step * finest / divisions;
  // Rows are a whole number of time steps apart.
  run.time_step = row_time / std::ceil(row_time / longest - 1e-9);
  DynamicsOptions options;
  options.duration = one.duration;
  options.density = domain.density;
  options.time_step = run.time_step;
  const double of_points = domain.length * domain.height * domain.thickness / domain.volume;
  double at_rest = 0;
  Progress progress(fmt::format("{}, {} elements", one.name, divisions));
  const auto rows = static_cast<int>(one.rows);
  lead_wave(run, [&] {
    const auto solver = make_dynamics_solver(model, material, options, one.threads);
    run_load_steps(*solver, one.duration, rows, rows, [&](const LoadStep& step, const Solver& now) {
      WaveRow row;
      row.time = step.time;
      row.end = one.pulse.at(step.time);
      gauges.read(now, row);
      const Energies energies = step.energies.value_or(Energies{});
      const double stored = of_points * step.record.elastic_energy;
      if (step.record.step == 0) at_rest = stored;
      row.work = domain.thickness * energies.external;
      const double agitation = of_points * mean_kinetic_energy(now.points());
      row.coherent = domain.thickness * energies.kinetic;
      row.kinetic = row.coherent + agitation;
      row.stored = stored - at_rest;
      row.dissipated = domain.thickness * energies.internal - row.stored - agitation;
      row.contacts = step.record.contacts;
      run.rows.push_back(row);
      run.steps += step.record.effort.iterations;
      run.cuts += step.record.effort.cuts;
      if (step.record.step < rows) Interrupt::check();
      progress.update(step.time / one.duration, fmt::format("{:.2f} ms", 1e3 * step.time));
    });
  });
  return run;
}

}  // namespace verification

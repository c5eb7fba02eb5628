#include "fe/output/vtk_series.hpp"

#include "app/state_files.hpp"
#include "fe/output/fields.hpp"
#include "fe/solver/forces.hpp"

#include <fmt/format.h>

namespace verification {
namespace {

void append(std::vector<double>& points, const Position& point) {
  points.insert(points.end(), {point.x(), point.y(), point.size() == 3 ? point.z() : 0.0});
}

// Nodal vectors with a third component for ParaView.
VtkArray nodal(const char* name, const Mesh& mesh, const Eigen::VectorXd& vector) {
  VtkArray array{name, 3, {}};
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node)
    append(array.values, mesh.moved(node, vector));
  return array;
}

// Means by element, weighted by area or volume; points of an element are consecutive.
std::vector<double> element_means(const PointField& points, std::size_t elements,
                                  std::size_t components, const std::vector<double>& values) {
  const std::size_t per_element = points.size() / elements;
  std::vector<double> means(elements * components, 0.0);
  for (std::size_t e = 0; e < elements; ++e) {
    double sum = 0;
    for (std::size_t p = e * per_element; p < (e + 1) * per_element; ++p) {
      const double weight = points.geometry(p).weight;
      sum += weight;
      for (std::size_t c = 0; c < components; ++c)
        means[e * components + c] += weight * values[p * components + c];
    }
    for (std::size_t c = 0; c < components; ++c) means[e * components + c] /= sum;
  }
  return means;
}

}  // namespace

VtkSeries::VtkSeries(const Model& model, std::filesystem::path stem,
                     std::vector<std::size_t> packings)
    : model_(model), stem_(std::move(stem)), packings_(std::move(packings)) {}

void VtkSeries::add(const LoadStep& step, const Solver& solver) {
  const int number = step.record.step;
  const PointField& points = solver.points();
  const Mesh& mesh = model_.mesh;
  const Eigen::VectorXd& displacement = solver.displacement();

  std::vector<VtkArray> at_points, at_elements;
  for (const Field& field : fields(mesh.dimension())) {
    const std::string name(field.name);
    at_points.push_back({name, field.components, values(field, points)});
    at_elements.push_back(
        {name, field.components,
         element_means(points, mesh.elements.size(), static_cast<std::size_t>(field.components),
                       at_points.back().values)});
  }
  std::vector<double> positions;
  for (std::size_t p = 0; p < points.size(); ++p)
    append(positions, current_position(mesh, points, p, displacement));
  write_vtp(file("points", number, "vtp"), positions, at_points);

  VtkMesh grid;
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node)
    append(grid.points, mesh.position(node) + mesh.moved(node, displacement));
  for (const std::vector<int>& element : mesh.elements) {
    grid.connectivity.insert(grid.connectivity.end(), element.begin(), element.end());
    grid.offsets.push_back(static_cast<std::int64_t>(grid.connectivity.size()));
    grid.types.push_back(element_type(mesh.kind).vtk);
  }
  Eigen::VectorXd applied = Eigen::VectorXd::Zero(displacement.size());
  add_external_force(model_, step.time, displacement, applied);
  grid.point_data = {nodal("displacement", mesh, displacement),
                     nodal("reaction_force", mesh, points.internal_force() - applied)};
  grid.cell_data = std::move(at_elements);
  write_vtu(file("mesh", number, "vtu"), grid);

  times_.push_back(step.time);
  steps_.push_back(number);
  write_series("points", "vtp");
  write_series("mesh", "vtu");
  for (const std::size_t point : packings_) {
    const std::string kind = fmt::format("packing{}", point);
    write_vtk(points.state(point), file(kind, number, "vtp"));
    write_series(kind, "vtp");
  }
}

void VtkSeries::save(CheckpointWriter& out) const {
  out.write(times_);
  out.write(steps_);
}

void VtkSeries::restore(CheckpointReader& in) {
  in.read(times_);
  in.read(steps_);
  if (times_.size() != steps_.size()) in.fail();
}

std::filesystem::path VtkSeries::file(const std::string& kind, int step,
                                      const char* extension) const {
  return fmt::format("{}_{}_{:04d}.{}", stem_.string(), kind, step, extension);
}

void VtkSeries::write_series(const std::string& kind, const char* extension) const {
  std::vector<VtkSeriesEntry> entries;
  for (std::size_t k = 0; k < times_.size(); ++k)
    entries.push_back({times_[k], file(kind, steps_[k], extension).filename().string()});
  write_pvd(fmt::format("{}_{}.pvd", stem_.string(), kind), entries);
}

}  // namespace verification

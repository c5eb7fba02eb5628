#include "fe/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace verification {

namespace {

// Modulus of uniaxial strain at F = I, mean of both directions [Pa].
double initial_modulus(const Material& material) {
  State state(material);
  const Evaluation start = evaluate(state, Tensor::Identity(), GRAINLAW_WANT_TANGENT_EXACT);
  check(start.status, "evaluating an integration point at F = I");
  return 0.5 * (start.tangent(0, 0) + start.tangent(3, 3));
}

}  // namespace

std::vector<PointField::Point> PointField::points_of(const Mesh& mesh) {
  std::vector<Point> points;
  for (const auto& element : mesh.elements) {
    const std::vector<Eigen::Vector2d> positions = mesh.positions(element);
    NodeRows centre(0, 2);
    if (mesh.kind == ElementKind::q4fbar)
      centre = quad_points(ElementKind::q4r, positions).front().gradient;
    for (const QuadPoint& geometry : quad_points(mesh.kind, positions))
      points.push_back({element, geometry, centre, Tensor::Identity(), Tensor::Zero(), 0, {}});
  }
  return points;
}

PointField::PointField(const Model& model, const Material& material)
    : points_(points_of(model.mesh)), set_(material, points_.size()) {
  const Mesh& mesh = model.mesh;
  if (mesh.kind == ElementKind::q4r && model.hourglass > 0)
    hourglass_ = Hourglass(mesh, model.hourglass, initial_modulus(material));
  if (model.average.length > 0)
    average_ = {mesh, model.average.length, model.average.modulus * initial_modulus(material)};
  displacement_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * mesh.nodes.size()));
  const std::size_t n = points_.size();
  reports_.resize(n, grainlaw_report_default());
  mesh_deformation_.resize(n, Tensor::Identity());
  mean_volume_.resize(n);
  deformation_.resize(n, Tensor::Identity());
  stress_.resize(n, Tensor::Zero());
  tangent_.resize(n, Tangent::Zero());
  volume_ = measure_scalar(state(0), GRAINLAW_REFERENCE_VOLUME);
}

Tensor PointField::gradient(const Point& point, const NodeRows& slopes,
                            const Eigen::VectorXd& displacement) {
  Tensor gradient = Tensor::Zero();
  for (std::size_t a = 0; a < point.nodes.size(); ++a)
    gradient +=
        displacement.segment<2>(2 * point.nodes[a]) * slopes.row(static_cast<Eigen::Index>(a));
  return gradient;
}

void PointField::deform(const Eigen::VectorXd& displacement) {
  displacement_ = displacement;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Point& point = points_[p];
    const NodeRows& slopes = point.geometry.gradient;
    const Tensor here = gradient(point, slopes, displacement);
    mesh_deformation_[p] = Tensor::Identity() + here;
    if (point.centre.rows() > 0)
      mean_volume_[p] = {here, gradient(point, point.centre, displacement), slopes, point.centre};
    deformation_[p] = mean_volume_[p].packing_deformation(mesh_deformation_[p]);
  }
}

double PointField::largest_change(const Eigen::VectorXd& displacement) const {
  double largest = 0;
  for (const Point& point : points_)
    largest = std::max(largest, gradient(point, point.geometry.gradient, displacement).norm());
  return largest;
}

void PointField::set_time_step(double step) {
  check(grainlaw_points_set_time_step(set_.get(), step), "telling the points their time step");
}

grainlaw_status PointField::evaluate(const Eigen::VectorXd& displacement, unsigned want,
                                     int threads) {
  const auto measure = cost_.measure(Stage::points);
  deform(displacement);
  for (grainlaw_report& report : reports_) report = grainlaw_report_default();
  last_ = set_.evaluate(numbers(deformation_), numbers(stress_), want,
                        want != 0 ? numbers(tangent_) : std::span<double>(), threads, {}, reports_);
  for (std::size_t p = 0; p < points_.size(); ++p) points_[p].effort.add(reports_[p]);
  return last_.status;
}

std::string PointField::message() const {
  return last_.summary.failed == 0 ? "" : "integration " + last_.message();
}

Eigen::VectorXd PointField::internal_force() const {
  const auto measure = cost_.measure(Stage::assembly);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(displacement_.size());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const auto& [gradient, weight, shape] = points_[p].geometry;
    const Tensor stress = mean_volume_[p].on_mesh(stress_[p]);
    for (std::size_t a = 0; a < points_[p].nodes.size(); ++a)
      force.segment<2>(2 * points_[p].nodes[a]) +=
          weight * stress * gradient.row(static_cast<Eigen::Index>(a)).transpose();
  }
  hourglass_.add_force(displacement_, force);
  average_.add_force(displacement_, force);
  return force;
}

void PointField::add_stiffness(Triplets& triplets) const {
  const auto measure = cost_.measure(Stage::assembly);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const auto& [gradient, weight, shape] = points_[p].geometry;
    const NodeRows& area = mean_volume_[p].by_node();
    const Tensor follow =
        MeanVolume::follow(tangent_[p], mesh_deformation_[p], mean_volume_[p].on_mesh(stress_[p]));
    // Adds K of @formula host for every pair of nodes a, b and components i, k.
    for (int a = 0; a < gradient.rows(); ++a)
      for (int b = 0; b < gradient.rows(); ++b)
        for (int i = 0; i < 2; ++i)
          for (int k = 0; k < 2; ++k) {
            double value = gradient.row(a) * tangent_[p].block<2, 2>(2 * i, 2 * k) *
                           gradient.row(b).transpose();
            if (area.rows() > 0) value += follow.row(i).dot(gradient.row(a)) * area(b, k);
            triplets.emplace_back(2 * points_[p].nodes[static_cast<std::size_t>(a)] + i,
                                  2 * points_[p].nodes[static_cast<std::size_t>(b)] + k,
                                  weight * value);
          }
  }
  hourglass_.add_stiffness(triplets);
  average_.add_stiffness(triplets);
}

void PointField::commit() {
  set_.commit();
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Point& point = points_[p];
    const Tensor change = deformation_[p] - point.committed_deformation;
    point.work += 0.5 * volume_ * (point.committed_stress + stress_[p]).cwiseProduct(change).sum();
    point.committed_deformation = deformation_[p];
    point.committed_stress = stress_[p];
    point.effort.history_advanced += reports_[p].history_advanced;
  }
}

void PointField::revert() { set_.revert(); }

void PointField::save(CheckpointWriter& out) const {
  const std::vector<std::byte> bytes = set_.save();
  out.write(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  for (const Point& point : points_) {
    out.write(point.committed_deformation);
    out.write(point.committed_stress);
    out.write(point.work);
  }
  out.write(displacement_);
  out.write(deformation_);
  out.write(stress_);
  out.write(tangent_);
}

void PointField::restore(CheckpointReader& in) {
  const auto bytes = in.get<std::string>();
  try {
    set_.load(std::as_bytes(std::span(bytes)));
  } catch (const grainlaw::StatusError& error) {
    if (error.status() == GRAINLAW_BAD_ARGUMENT) in.fail();
    if (error.status() == GRAINLAW_WRONG_MATERIAL)
      throw InputError(in.path().string() + ": was made with another material or packing");
    throw;
  }
  for (Point& point : points_) {
    in.read(point.committed_deformation);
    in.read(point.committed_stress);
    in.read(point.work);
    point.effort = {};
  }
  in.read(displacement_);
  in.read(deformation_);
  in.read(stress_);
  in.read(tangent_);
  if (deformation_.size() != size() || stress_.size() != size() || tangent_.size() != size())
    in.fail();
  deform(displacement_);
}

Effort PointField::effort() const {
  Effort sum;
  for (const Point& point : points_) {
    sum.evaluations = std::max(sum.evaluations, point.effort.evaluations);
    sum.subincrements = std::max(sum.subincrements, point.effort.subincrements);
    sum.history_advanced = std::max(sum.history_advanced, point.effort.history_advanced);
    sum.relaxation_steps += point.effort.relaxation_steps;
    sum.servo_corrections += point.effort.servo_corrections;
    sum.factorisations += point.effort.factorisations;
  }
  const auto count = static_cast<int>(points_.size());
  sum.relaxation_steps /= count;
  sum.servo_corrections /= count;
  sum.factorisations /= count;
  return sum;
}

Record PointField::record() {
  std::vector<Record> records;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    // F is that of the mesh, whose mean is that of the body; the Cauchy stress is the packing's.
    records.push_back(make_record(state(p), mesh_deformation_[p],
                                  mean_volume_[p].on_mesh(stress_[p]), reports_[p]));
    records.back().external_work = points_[p].work;
  }
  Record record = mean(records);
  record.effort = effort();
  for (Point& point : points_) point.effort = {};
  return record;
}

}  // namespace verification

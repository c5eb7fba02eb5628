#include "fe/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace verification {

namespace {

// Modulus of uniaxial strain at F = I, mean over the axes [Pa].
double initial_modulus(const Material& material, int dimension) {
  State state(material);
  return in_dimension(dimension, [&]<int D>() {
    const EvaluationOf<D> start =
        evaluate_of<D>(state, TensorOf<D>::Identity(), GRAINLAW_WANT_TANGENT_EXACT);
    check(start.status, "evaluating an integration point at F = I");
    double sum = 0;
    for (int i = 0; i < D; ++i) sum += start.tangent(i * (D + 1), i * (D + 1));
    return sum / D;
  });
}

// A list of the identity for every point.
std::vector<double> identities(int dimension, std::size_t points) {
  const auto axes = static_cast<std::size_t>(dimension);
  std::vector<double> values(points * axes * axes, 0.0);
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t i = 0; i < axes; ++i) values[(p * axes + i) * axes + i] = 1;
  return values;
}

}  // namespace

std::vector<PointField::Point> PointField::points_of(const Mesh& mesh) {
  const ElementType& type = element_type(mesh.kind);
  std::vector<Point> points;
  for (const auto& element : mesh.elements) {
    const std::vector<Position> positions = mesh.positions(element);
    NodeRows slopes;
    if (type.mean_volume) slopes = quad_point(type, positions, centre(type)).gradient;
    for (const QuadPoint& geometry : quad_points(mesh.kind, positions))
      points.push_back({element, geometry, slopes, 0, {}});
  }
  return points;
}

PointField::PointField(const Model& model, const Material& material)
    : dimension_(model.mesh.dimension()),
      points_(points_of(model.mesh)),
      set_(material, points_.size()) {
  const Mesh& mesh = model.mesh;
  if (mesh.kind == ElementKind::q4r && model.hourglass > 0)
    hourglass_ = Hourglass(mesh, model.hourglass, initial_modulus(material, dimension_));
  if (model.average.length > 0)
    average_ = {mesh, model.average.length,
                model.average.modulus * initial_modulus(material, dimension_)};
  displacement_ = Eigen::VectorXd::Zero(mesh.dofs());
  const std::size_t n = points_.size();
  reports_.resize(n, grainlaw_report_default());
  seconds_.resize(n);
  last_seconds_.resize(n);
  const std::size_t components = per_tensor();
  mesh_deformation_ = deformation_ = committed_deformation_ = identities(dimension_, n);
  mean_volume_.resize(n);
  stress_.resize(n * components);
  committed_stress_.resize(n * components);
  tangent_.resize(n * components * components);
  volume_ = measure_scalar(state(0), GRAINLAW_REFERENCE_VOLUME);
}

template <int D>
TensorOf<D> PointField::gradient(const Point& point, const NodeRows& slopes,
                                 const Eigen::VectorXd& displacement) {
  TensorOf<D> gradient = TensorOf<D>::Zero();
  for (std::size_t a = 0; a < point.nodes.size(); ++a)
    gradient +=
        displacement.segment<D>(D * point.nodes[a]) * slopes.row(static_cast<Eigen::Index>(a));
  return gradient;
}

void PointField::deform(const Eigen::VectorXd& displacement) {
  displacement_ = displacement;
  in_dimension(dimension_, [&]<int D>() {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Point& point = points_[p];
      const NodeRows& slopes = point.geometry.gradient;
      const TensorOf<D> here = gradient<D>(point, slopes, displacement);
      const TensorOf<D> deformation = TensorOf<D>::Identity() + here;
      if (point.centre.rows() > 0)
        mean_volume_[p] = {here, gradient<D>(point, point.centre, displacement), slopes,
                           point.centre};
      put(mesh_deformation_, p, deformation);
      put(deformation_, p, mean_volume_[p].packing_deformation(deformation));
    }
  });
}

double PointField::largest_change(const Eigen::VectorXd& displacement) const {
  return in_dimension(dimension_, [&]<int D>() {
    double largest = 0;
    for (const Point& point : points_)
      largest = std::max(largest, gradient<D>(point, point.geometry.gradient, displacement).norm());
    return largest;
  });
}

void PointField::set_time_step(double step) {
  check(grainlaw_points_set_time_step(set_.get(), step), "telling the points their time step");
}

grainlaw_status PointField::evaluate(const Eigen::VectorXd& displacement, unsigned want,
                                     int threads) {
  const auto measure = cost_.measure(Stage::points);
  deform(displacement);
  for (grainlaw_report& report : reports_) report = grainlaw_report_default();
  last_ =
      set_.evaluate(deformation_, stress_, want,
                    want != 0 ? std::span(tangent_) : std::span<double>(), threads, {}, reports_);
  check(grainlaw_points_cost(set_.get(), last_seconds_.data()), "asking what points took");
  for (std::size_t p = 0; p < points_.size(); ++p) {
    points_[p].effort.add(reports_[p]);
    seconds_[p] += last_seconds_[p];
  }
  return last_.status;
}

std::string PointField::message() const {
  return last_.summary.failed == 0 ? "" : "integration " + last_.message();
}

Eigen::VectorXd PointField::internal_force() const {
  const auto measure = cost_.measure(Stage::assembly);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(displacement_.size());
  in_dimension(dimension_, [&]<int D>() {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const auto& [gradient, weight, shape] = points_[p].geometry;
      const TensorOf<D> stress = mean_volume_[p].on_mesh(tensor<D>(stress_, p));
      for (std::size_t a = 0; a < points_[p].nodes.size(); ++a)
        force.segment<D>(D * points_[p].nodes[a]) +=
            weight * stress * gradient.row(static_cast<Eigen::Index>(a)).transpose();
    }
  });
  hourglass_.add_force(displacement_, force);
  average_.add_force(displacement_, force);
  return force;
}

void PointField::add_stiffness(Triplets& triplets) const {
  const auto measure = cost_.measure(Stage::assembly);
  in_dimension(dimension_, [&]<int D>() {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const auto& [gradient, weight, shape] = points_[p].geometry;
      const MeanVolume& mean = mean_volume_[p];
      const NodeRows& ratio = mean.by_node();
      const TangentOf<D> tangent = mean.tangent_on_mesh<D>(this->tangent<D>(p));
      const TensorOf<D> follow = MeanVolume::follow<D>(tangent, tensor<D>(mesh_deformation_, p),
                                                       mean.on_mesh(tensor<D>(stress_, p)));
      // Adds K of @formula host for every pair of nodes a, b and components i, k.
      for (int a = 0; a < gradient.rows(); ++a)
        for (int b = 0; b < gradient.rows(); ++b)
          for (int i = 0; i < D; ++i)
            for (int k = 0; k < D; ++k) {
              double value = gradient.row(a) * tangent.template block<D, D>(D * i, D * k) *
                             gradient.row(b).transpose();
              if (ratio.rows() > 0) value += follow.row(i).dot(gradient.row(a)) * ratio(b, k);
              triplets.emplace_back(D * points_[p].nodes[static_cast<std::size_t>(a)] + i,
                                    D * points_[p].nodes[static_cast<std::size_t>(b)] + k,
                                    weight * value);
            }
    }
  });
  hourglass_.add_stiffness(triplets);
  average_.add_stiffness(triplets);
}

void PointField::commit() {
  set_.commit();
  in_dimension(dimension_, [&]<int D>() {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const TensorOf<D> before = tensor<D>(committed_deformation_, p),
                        now = tensor<D>(deformation_, p);
      const TensorOf<D> change = now - before;
      const TensorOf<D> stress_before = tensor<D>(committed_stress_, p),
                        stress = tensor<D>(stress_, p);
      points_[p].work += 0.5 * volume_ * (stress_before + stress).cwiseProduct(change).sum();
      points_[p].effort.history_advanced += reports_[p].history_advanced;
    }
  });
  committed_deformation_ = deformation_;
  committed_stress_ = stress_;
}

void PointField::revert() { set_.revert(); }

void PointField::save(CheckpointWriter& out) const {
  const std::vector<std::byte> bytes = set_.save();
  out.write(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  for (const Point& point : points_) out.write(point.work);
  out.write(displacement_);
  for (const auto* values :
       {&committed_deformation_, &committed_stress_, &deformation_, &stress_, &tangent_})
    out.write(*values);
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
    in.read(point.work);
    point.effort = {};
  }
  in.read(displacement_);
  for (auto* values :
       {&committed_deformation_, &committed_stress_, &deformation_, &stress_, &tangent_}) {
    const std::size_t expected = values->size();
    in.read(*values);
    if (values->size() != expected) in.fail();
  }
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

BodyRecord PointField::record() {
  BodyRecord record = in_dimension(dimension_, [&]<int D>() {
    std::vector<RecordOf<D>> records;
    std::vector<double> volume;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      // F is that of the mesh, whose mean is that of the body; the Cauchy stress is the packing's.
      records.push_back(make_record<D>(state(p), tensor<D>(mesh_deformation_, p),
                                       mean_volume_[p].on_mesh(tensor<D>(stress_, p)),
                                       reports_[p]));
      records.back().external_work = points_[p].work;
      volume.push_back(points_[p].geometry.weight);
    }
    return BodyRecord(mean(records, std::move(volume)));
  });
  record.effort = effort();
  for (Point& point : points_) point.effort = {};
  return record;
}

}  // namespace verification

#include "brick/model.hpp"

#include <algorithm>

namespace verification {

namespace {

// Calls function for every condition on displacements, with its name.
template <class Function>
void for_each_condition(const BrickModel& model, Function&& function) {
  for (const auto& condition : model.displacements)
    function(condition.name, condition.nodes, condition.component);
  for (const auto& tie : model.ties) function(tie.name, tie.nodes, tie.component);
}

}  // namespace

std::vector<std::string> force_columns(const BrickModel& model) {
  std::vector<std::string> columns;
  for_each_condition(model, [&](const std::string& name, const std::vector<int>&, int) {
    columns.push_back(name + "_displacement[m]");
    columns.push_back(name + "_force[N]");
  });
  return columns;
}

std::vector<double> force_values(const BrickModel& model, const Eigen::VectorXd& displacement,
                                 const Eigen::VectorXd& residual) {
  std::vector<double> values;
  for_each_condition(model, [&](const std::string&, const std::vector<int>& nodes, int component) {
    double force = 0;
    for (const int node : nodes) force -= residual(3 * node + component);
    values.push_back(displacement(3 * nodes.front() + component));
    values.push_back(force);
  });
  return values;
}

BrickUnknowns::BrickUnknowns(const BrickModel& model) {
  const std::size_t components = 3 * model.mesh.nodes.size();
  constexpr int open = -2;
  number.assign(components, open);
  end = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(components));
  const auto dof = [](int node, int component) {
    return static_cast<std::size_t>(3 * node + component);
  };
  for (const auto& condition : model.displacements)
    for (const int node : condition.nodes) {
      number[dof(node, condition.component)] = -1;
      end(3 * node + condition.component) = condition.value;
    }
  for (const auto& tie : model.ties) {
    for (const int node : tie.nodes) number[dof(node, tie.component)] = count;
    ++count;
  }
  for (int& unknown : number)
    if (unknown == open) unknown = count++;
}

Eigen::VectorXd BrickUnknowns::reduce(const Eigen::VectorXd& force) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(count);
  for (std::size_t k = 0; k < number.size(); ++k)
    if (number[k] >= 0) result(number[k]) += force(static_cast<Eigen::Index>(k));
  return result;
}

Eigen::VectorXd BrickUnknowns::expand(const Eigen::VectorXd& unknowns) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(end.size());
  for (std::size_t k = 0; k < number.size(); ++k)
    if (number[k] >= 0) result(static_cast<Eigen::Index>(k)) = unknowns(number[k]);
  return result;
}

BrickField::BrickField(const BrickModel& model, const Material& material, int threads)
    : model_(model), threads_(threads), set_(material, 8 * model.mesh.elements.size()) {
  for (const auto& element : model.mesh.elements)
    for (const BrickPoint& point : brick_points(model.mesh, element)) {
      nodes_.push_back(element);
      geometry_.push_back(point);
    }
  const std::size_t n = nodes_.size();
  deformation_.resize(n, TensorOf<3>::Identity());
  committed_deformation_ = deformation_;
  stress_.resize(n, TensorOf<3>::Zero());
  committed_stress_ = stress_;
  tangent_.resize(n, TangentOf<3>::Zero());
  reports_.resize(n, grainlaw_report_default());
  efforts_.resize(n);
  work_.resize(n);
  volume_ = measure_scalar(state(0), GRAINLAW_REFERENCE_VOLUME);
}

TensorOf<3> BrickField::deformed(TensorOf<3> F, std::size_t point,
                                 const Eigen::VectorXd& displacement) const {
  for (int a = 0; a < 8; ++a)
    F += displacement.segment<3>(3 * nodes_[point][static_cast<std::size_t>(a)]) *
         geometry_[point].gradient.row(a);
  return F;
}

double BrickField::largest_change(const Eigen::VectorXd& displacement) const {
  double largest = 0;
  for (std::size_t p = 0; p < nodes_.size(); ++p)
    largest = std::max(largest, deformed(TensorOf<3>::Zero(), p, displacement).norm());
  return largest;
}

grainlaw_status BrickField::evaluate(const Eigen::VectorXd& displacement, unsigned want) {
  for (std::size_t p = 0; p < nodes_.size(); ++p) {
    deformation_[p] = deformed(TensorOf<3>::Identity(), p, displacement);
    reports_[p] = grainlaw_report_default();
  }
  last_ = set_.evaluate(numbers(deformation_), numbers(stress_), want, numbers(tangent_), threads_,
                        {}, reports_);
  for (std::size_t p = 0; p < reports_.size(); ++p) efforts_[p].add(reports_[p]);
  return last_.status;
}

BrickSystem BrickField::assemble(const Eigen::VectorXd& displacement) const {
  const auto size = displacement.size();
  Eigen::VectorXd internal = Eigen::VectorXd::Zero(size);
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t p = 0; p < nodes_.size(); ++p) {
    const BrickPoint& point = geometry_[p];
    for (int a = 0; a < 8; ++a) {
      const int row = 3 * nodes_[p][static_cast<std::size_t>(a)];
      internal.segment<3>(row) += point.volume * stress_[p] * point.gradient.row(a).transpose();
      for (int b = 0; b < 8; ++b) {
        const int column = 3 * nodes_[p][static_cast<std::size_t>(b)];
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k) {
            const double sum = point.gradient.row(a).dot(tangent_[p].block<3, 3>(3 * i, 3 * k) *
                                                         point.gradient.row(b).transpose());
            triplets.emplace_back(row + i, column + k, point.volume * sum);
          }
      }
    }
  }
  BrickSystem system;
  system.scale = internal.norm();
  system.residual = -internal;
  for (const auto& pressure : model_.pressures)
    for (const auto& face : pressure.faces) {
      std::array<Eigen::Vector3d, 4> positions;
      for (std::size_t a = 0; a < 4; ++a)
        positions[a] = model_.mesh.nodes[static_cast<std::size_t>(face[a])] +
                       displacement.segment<3>(3 * face[a]);
      const FacePressure load = face_pressure(positions);
      for (int a = 0; a < 12; ++a) {
        const int row = 3 * face[static_cast<std::size_t>(a / 3)] + a % 3;
        system.residual(row) += pressure.value * load.force(a);
        for (int b = 0; b < 12; ++b)
          triplets.emplace_back(row, 3 * face[static_cast<std::size_t>(b / 3)] + b % 3,
                                -pressure.value * load.derivative(a, b));
      }
    }
  system.stiffness.resize(size, size);
  system.stiffness.setFromTriplets(triplets.begin(), triplets.end());
  return system;
}

void BrickField::commit() {
  set_.commit();
  for (std::size_t p = 0; p < nodes_.size(); ++p) {
    const TensorOf<3> change = deformation_[p] - committed_deformation_[p];
    work_[p] += 0.5 * volume_ * (committed_stress_[p] + stress_[p]).cwiseProduct(change).sum();
    efforts_[p].history_advanced += reports_[p].history_advanced;
  }
  committed_deformation_ = deformation_;
  committed_stress_ = stress_;
}

void BrickField::revert() { set_.revert(); }

RecordOf<3> BrickField::record() {
  std::vector<RecordOf<3>> records;
  Effort effort;
  for (std::size_t p = 0; p < nodes_.size(); ++p) {
    records.push_back(make_record<3>(state(p), deformation_[p], stress_[p], reports_[p]));
    records.back().external_work = work_[p];
    Effort& one = efforts_[p];
    effort.evaluations = std::max(effort.evaluations, one.evaluations);
    effort.subincrements = std::max(effort.subincrements, one.subincrements);
    effort.history_advanced = std::max(effort.history_advanced, one.history_advanced);
    effort.relaxation_steps += one.relaxation_steps;
    effort.factorisations += one.factorisations;
    one = {};
  }
  effort.relaxation_steps /= static_cast<long>(nodes_.size());
  effort.factorisations /= static_cast<int>(nodes_.size());
  RecordOf<3> result = mean(records);
  result.effort = effort;
  return result;
}

}  // namespace verification

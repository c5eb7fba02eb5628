// A total Lagrangian finite element model whose integration points are a set of grainlaw.
#pragma once

#include "app/library.hpp"
#include "app/record.hpp"
#include "fe/checkpoint.hpp"
#include "fe/conditions/conditions.hpp"
#include "fe/conditions/side_loads.hpp"
#include "fe/cost.hpp"
#include "fe/hourglass.hpp"
#include "fe/mean_volume.hpp"
#include "fe/mesh/mesh.hpp"
#include "fe/strain_average.hpp"

#include <vector>

namespace verification {

struct Model {
  Mesh mesh;
  std::vector<PrescribedDisplacement> displacements;
  std::vector<Tie> ties;
  std::vector<Periodic> periodics;
  std::vector<Resultant> resultants;
  Loads loads;
  double hourglass = 0.05;  // relative to the initial modulus; one-point elements only [-]
  AverageOptions average;
};

// Integration points of a model, numbered by elements.
class PointField {
 public:
  // Throws ComputationError when F = I cannot be evaluated.
  PointField(const Model& model, const Material& material);

  // Sets the duration of the following evaluations; with solver.viscous_rate the drag depends on
  // it.
  void set_time_step(double step);
  // Evaluates F at every point for these displacements in one batch. Returns the status of the
  // first failed point.
  grainlaw_status evaluate(const Eigen::VectorXd& displacement, unsigned want, int threads);
  // Smallest step ratio of the failed points, and the first of these with its message.
  [[nodiscard]] double step_ratio() const { return last_.summary.step_ratio; }
  [[nodiscard]] std::string message() const;

  // Largest change of F (Frobenius norm) at a point due to this change of displacement.
  [[nodiscard]] double largest_change(const Eigen::VectorXd& displacement) const;

  // Nodal forces of the last evaluation's stresses, @formula host [N/m], and their derivative.
  [[nodiscard]] Eigen::VectorXd internal_force() const;
  void add_stiffness(Triplets& triplets) const;

  // Commits the trials and adds their work, or drops them.
  void commit();
  void revert();

  // Saves the committed states and the last evaluation, which is the committed equilibrium after
  // `commit` and `record`.
  void save(CheckpointWriter& out) const;
  void restore(CheckpointReader& in);

  // Cost of evaluations and assembly; the solver adds its own.
  [[nodiscard]] Cost& cost() const { return cost_; }

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  // Mean over the points of the last evaluation, and the effort since the last call.
  Record record();
  // Effort since the last record().
  [[nodiscard]] Effort effort() const;
  [[nodiscard]] const std::vector<int>& nodes(std::size_t point) const {
    return points_[point].nodes;
  }
  [[nodiscard]] const QuadPoint& geometry(std::size_t point) const {
    return points_[point].geometry;
  }
  // Values of the last evaluation, as the packings have them.
  [[nodiscard]] const Tensor& deformation(std::size_t point) const { return deformation_[point]; }
  [[nodiscard]] const Tensor& stress(std::size_t point) const { return stress_[point]; }
  [[nodiscard]] const grainlaw_report& report(std::size_t point) const { return reports_[point]; }
  [[nodiscard]] const grainlaw_state* state(std::size_t point) const { return set_.state(point); }

 private:
  struct Point {
    std::vector<int> nodes;
    QuadPoint geometry;
    NodeRows centre;  // q4fbar: dN_a/dX at the element's centre; others: empty
    Tensor committed_deformation = Tensor::Identity();
    Tensor committed_stress = Tensor::Zero();
    double work = 0;  // external work since F = I [J]
    Effort effort;
  };

  [[nodiscard]] static std::vector<Point> points_of(const Mesh& mesh);
  [[nodiscard]] static Tensor gradient(const Point& point, const NodeRows& slopes,
                                       const Eigen::VectorXd& displacement);
  // Computes F of mesh and packing at every point.
  void deform(const Eigen::VectorXd& displacement);

  std::vector<Point> points_;
  Hourglass hourglass_;
  StrainAverage average_;
  Eigen::VectorXd displacement_;  // of the last evaluation [m]
  Points set_;
  grainlaw::PointsEvaluation last_;  // last evaluation
  std::vector<grainlaw_report> reports_;
  std::vector<Tensor> mesh_deformation_;
  std::vector<MeanVolume> mean_volume_;
  std::vector<Tensor> deformation_;  // of the packings, with their stress and tangent
  std::vector<Tensor> stress_;
  std::vector<Tangent> tangent_;
  mutable Cost cost_;
  double volume_ = 0;  // of one representative volume at F = I [m3]
};

}  // namespace verification

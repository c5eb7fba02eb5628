// A total Lagrangian finite element model whose integration points are a set of grainlaw.
#pragma once

#include "app/library.hpp"
#include "fe/body_record.hpp"
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

  // Sets the duration of the following evaluations, for solver.viscous_rate and solver.inertia.
  void set_time_step(double step);
  // Evaluates F at every point for these displacements in one batch. Returns the status of the
  // first failed point.
  grainlaw_status evaluate(const Eigen::VectorXd& displacement, unsigned want, int threads);
  // Smallest step ratio of the failed points, and the first of these with its message.
  [[nodiscard]] double step_ratio() const { return last_.summary.step_ratio; }
  [[nodiscard]] std::string message() const;

  // Largest change of F (Frobenius norm) at a point due to this change of displacement.
  [[nodiscard]] double largest_change(const Eigen::VectorXd& displacement) const;

  // Nodal forces of the last evaluation's stresses, @formula host [N/m], of solids [N], and their
  // derivative.
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
  // Processor time of the evaluations of each point so far [s].
  [[nodiscard]] const std::vector<double>& seconds() const { return seconds_; }

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] std::size_t size() const { return points_.size(); }
  // Mean over the points of the last evaluation, and the effort since the last call.
  BodyRecord record();
  // Effort since the last record().
  [[nodiscard]] Effort effort() const;
  [[nodiscard]] const std::vector<int>& nodes(std::size_t point) const {
    return points_[point].nodes;
  }
  [[nodiscard]] const QuadPoint& geometry(std::size_t point) const {
    return points_[point].geometry;
  }
  // F and P of the last evaluation, as the packings have them.
  using Values =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  [[nodiscard]] Values deformation(std::size_t point) const {
    return {&deformation_[point * per_tensor()], dimension_, dimension_};
  }
  [[nodiscard]] Values stress(std::size_t point) const {
    return {&stress_[point * per_tensor()], dimension_, dimension_};
  }
  [[nodiscard]] const grainlaw_report& report(std::size_t point) const { return reports_[point]; }
  [[nodiscard]] const grainlaw_state* state(std::size_t point) const { return set_.state(point); }

 private:
  struct Point {
    std::vector<int> nodes;
    QuadPoint geometry;
    NodeRows centre;  // F-bar: dN_a/dX at the element's centre; others: empty
    double work = 0;  // external work since F = I [J]
    Effort effort;
  };

  [[nodiscard]] static std::vector<Point> points_of(const Mesh& mesh);
  [[nodiscard]] std::size_t per_tensor() const {
    return static_cast<std::size_t>(dimension_ * dimension_);
  }
  // Tensor of a point in a list.
  template <int D>
  [[nodiscard]] static TensorOf<D> tensor(const std::vector<double>& values, std::size_t point) {
    return TensorOf<D>::Map(&values[point * D * D]);
  }
  template <int D>
  static void put(std::vector<double>& values, std::size_t point, const TensorOf<D>& tensor) {
    TensorOf<D>::Map(&values[point * D * D]) = tensor;
  }
  template <int D>
  [[nodiscard]] TangentOf<D> tangent(std::size_t point) const {
    return TangentOf<D>::Map(&tangent_[point * D * D * D * D]);
  }
  template <int D>
  [[nodiscard]] static TensorOf<D> gradient(const Point& point, const NodeRows& slopes,
                                            const Eigen::VectorXd& displacement);
  // Computes F of mesh and packing at every point.
  void deform(const Eigen::VectorXd& displacement);

  int dimension_;
  std::vector<Point> points_;
  Hourglass hourglass_;
  StrainAverage average_;
  Eigen::VectorXd displacement_;  // of the last evaluation [m]
  Points set_;
  grainlaw::PointsEvaluation last_;  // last evaluation
  std::vector<grainlaw_report> reports_;
  // Components of all points, as the library wants them.
  std::vector<double> mesh_deformation_;
  std::vector<double> deformation_;  // of the packings, with their stress and tangent
  std::vector<double> stress_;
  std::vector<double> tangent_;
  std::vector<double> committed_deformation_, committed_stress_;
  std::vector<MeanVolume> mean_volume_;
  mutable Cost cost_;
  std::vector<double> seconds_, last_seconds_;  // of all evaluations, of the last
  double volume_ = 0;                           // of one representative volume at F = I [m3]
};

}  // namespace verification

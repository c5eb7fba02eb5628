// A body of bricks: mesh, conditions, and a packing of spheres per integration point.
#pragma once

#include "app/library.hpp"
#include "app/record.hpp"
#include "brick/mesh.hpp"

#include <Eigen/Sparse>

#include <string>
#include <vector>

namespace verification {

struct BrickModel {
  struct Displacement {
    std::string name;  // for tables, e.g. "top_z"
    std::vector<int> nodes;
    int component = 0;
    double value = 0;  // at time 1, reached linearly [m]
  };
  struct Tie {
    std::string name;
    std::vector<int> nodes;
    int component = 0;
  };
  struct Pressure {
    std::vector<std::array<int, 4>> faces;
    double value = 0;  // [Pa], compression positive; follows the deformed faces
  };

  BrickMesh mesh;
  std::vector<Displacement> displacements;
  std::vector<Tie> ties;
  std::vector<Pressure> pressures;
};

// Names and values of table columns, for every prescribed displacement, then every tie: its
// displacement [m] and its force on the body [N].
std::vector<std::string> force_columns(const BrickModel& model);
std::vector<double> force_values(const BrickModel& model, const Eigen::VectorXd& displacement,
                                 const Eigen::VectorXd& residual);

// Unknown of every displacement component; component i of node n is 3 n + i.
struct BrickUnknowns {
  explicit BrickUnknowns(const BrickModel& model);

  std::vector<int> number;  // -1: prescribed
  Eigen::VectorXd end;      // prescribed displacement at time 1, else 0 [m]
  int count = 0;

  [[nodiscard]] Eigen::VectorXd reduce(const Eigen::VectorXd& force) const;
  [[nodiscard]] Eigen::VectorXd expand(const Eigen::VectorXd& unknowns) const;
};

// Residual and stiffness over all displacement components.
struct BrickSystem {
  Eigen::VectorXd residual;               // external minus internal force [N]
  Eigen::SparseMatrix<double> stiffness;  // minus its derivative [N/m]
  double scale = 1;                       // |internal force| [N]
};

class BrickField {
 public:
  BrickField(const BrickModel& model, const Material& material, int threads);

  // Sets the number of load steps that following increments take.
  void set_time_step(double step) { set_.set_time_step(step); }
  // Evaluates all points and keeps the result for assemble(). Returns recoverable failures; throws
  // StatusError.
  grainlaw_status evaluate(const Eigen::VectorXd& displacement, unsigned want);
  // Largest change of F (Frobenius norm) at a point due to this change of displacement.
  [[nodiscard]] double largest_change(const Eigen::VectorXd& displacement) const;
  [[nodiscard]] BrickSystem assemble(const Eigen::VectorXd& displacement) const;
  void commit();
  void revert();

  // Means over the points, and the effort since the last call.
  RecordOf<3> record();
  [[nodiscard]] const grainlaw_summary& summary() const { return last_.summary; }
  [[nodiscard]] const grainlaw_state* state(std::size_t point) const { return set_.state(point); }

 private:
  // F plus the gradient of a displacement at a point.
  [[nodiscard]] TensorOf<3> deformed(TensorOf<3> F, std::size_t point,
                                     const Eigen::VectorXd& displacement) const;

  const BrickModel& model_;
  int threads_;
  Points set_;
  std::vector<std::array<int, 8>> nodes_;
  std::vector<BrickPoint> geometry_;
  std::vector<TensorOf<3>> deformation_, stress_, committed_deformation_, committed_stress_;
  std::vector<TangentOf<3>> tangent_;
  std::vector<grainlaw_report> reports_;
  grainlaw::PointsEvaluation last_;
  std::vector<Effort> efforts_;
  std::vector<double> work_;  // external work of each packing [J]
  double volume_ = 0;         // volume of a packing at F = I [m3]
};

}  // namespace verification

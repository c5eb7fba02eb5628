// What the last part of a load step moved, as a first guess of the next.
#pragma once

#include "fe/checkpoint.hpp"

#include <Eigen/Dense>

#include <utility>

namespace verification {

// Grains with drag expect to go on as they went (solver.viscous_inertia), and the committed tangent is
// that of an increment, not of standing still: the last move once more is the nearer guess.
class LastMove {
 public:
  // All components [m], and what of them was prescribed.
  void keep(Eigen::VectorXd move, Eigen::VectorXd prescribed) {
    move_ = std::move(move);
    prescribed_ = std::move(prescribed);
  }

  // As much of it as now is prescribed; empty where that does not go on the same way.
  [[nodiscard]] Eigen::VectorXd once_more(const Eigen::VectorXd& prescribed) const {
    constexpr double longest = 3;         // as far as drag follows [-]
    constexpr double another_way = 1e-9;  // more than rounding turns a direction by [-]
    const double square = prescribed_.squaredNorm();
    if (!(square > 0)) return {};
    const double ratio = prescribed.dot(prescribed_) / square;
    const double aside = (prescribed - ratio * prescribed_).norm();
    if (!(ratio > 0 && ratio <= longest && aside <= another_way * prescribed.norm())) return {};
    return ratio * move_;
  }

  void save(CheckpointWriter& out) const {
    out.write(move_);
    out.write(prescribed_);
  }
  void restore(CheckpointReader& in) {
    in.read(move_);
    in.read(prescribed_);
  }

 private:
  Eigen::VectorXd move_, prescribed_;
};

}  // namespace verification

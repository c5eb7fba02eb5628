// Displacement of the last part of a load step, as first guess of the next.
#pragma once

#include "fe/checkpoint.hpp"

#include <Eigen/Dense>

#include <utility>

namespace verification {

// Guess by repetition. Drag expects particles to continue (solver.viscous_number), and the committed
// tangent is that of an increment. Repeating the last displacement is then the better guess.
class LastDisplacement {
 public:
  // Keeps a displacement of all components [m], and its prescribed part.
  void keep(Eigen::VectorXd displacement, Eigen::VectorXd prescribed) {
    displacement_ = std::move(displacement);
    prescribed_ = std::move(prescribed);
  }

  // The last displacement scaled to the present prescription; empty where that has another
  // direction.
  [[nodiscard]] Eigen::VectorXd once_more(const Eigen::VectorXd& prescribed) const {
    constexpr double longest = 3;         // limit of the repetition [-]
    constexpr double another_way = 1e-9;  // rounding of a direction [-]
    const double square = prescribed_.squaredNorm();
    if (!(square > 0)) return {};
    const double ratio = prescribed.dot(prescribed_) / square;
    const double aside = (prescribed - ratio * prescribed_).norm();
    if (!(ratio > 0 && ratio <= longest && aside <= another_way * prescribed.norm())) return {};
    return ratio * displacement_;
  }

  void save(CheckpointWriter& out) const {
    out.write(displacement_);
    out.write(prescribed_);
  }
  void restore(CheckpointReader& in) {
    in.read(displacement_);
    in.read(prescribed_);
  }

 private:
  Eigen::VectorXd displacement_, prescribed_;
};

}  // namespace verification

// How much of the elastic stiffness Newton's method adds to the tangent.
#pragma once

#include <algorithm>

namespace verification {

// Share of it in the next solve, by the residuals before and after the last correction: none while
// they fall, more where they rise, less again where they fall fast or, held back by it, slowly.
class ElasticShare {
 public:
  explicit ElasticShare(double first) : first_(first) {}  // the least but none [-]

  void update(double before, double after) {
    constexpr double more = 4, less = 1.0 / 3;
    constexpr double slow = 0.7, fast = 0.3;  // of the residual is left
    if (after >= before || (share_ == 0 && after > slow * before)) {
      share_ = std::min(1.0, std::max(first_, more * share_));
    } else if (after > slow * before) {
      share_ = std::max(first_, less * share_);
    } else if (after < fast * before) {
      share_ = share_ > first_ ? std::max(first_, less * share_) : 0;
    }
  }

  [[nodiscard]] double value() const { return share_; }

 private:
  double first_;
  double share_ = 0;
};

}  // namespace verification

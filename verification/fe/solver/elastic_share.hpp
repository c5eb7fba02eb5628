// Share of the elastic stiffness in Newton's matrix.
#pragma once

#include <algorithm>

namespace verification {

// Share in the next solve, from the residuals before and after the last correction. It is zero
// while residuals fall and grows where they rise. It shrinks where they fall fast, or slowly
// because of it.
class ElasticShare {
 public:
  explicit ElasticShare(double first) : first_(first) {}  // least nonzero share [-]

  void update(double before, double after) {
    constexpr double more = 4, less = 1.0 / 3;
    constexpr double slow = 0.7, fast = 0.3;  // ratios of the residual
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

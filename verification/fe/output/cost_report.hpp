// What the load steps of a run cost, for the user.
#pragma once

#include "fe/solver/solver.hpp"

#include <string>

namespace verification {

class CostReport {
 public:
  // After every step. The clock starts with the first, whose own cost is not counted.
  void add(const LoadStep& step, const Solver& solver);
  // Lines, each with its end: cost per point and load step, and where the time went.
  [[nodiscard]] std::string summary(const Solver& solver) const;

 private:
  bool started_ = false;
  int steps_ = 0;
  double evaluations_ = 0;  // per point
  Spent start_;
  Spent total_;
  std::array<Spent, stages> at_start_;
};

}  // namespace verification

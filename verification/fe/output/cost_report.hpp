// What the load steps of a run cost: a table, and its sum for the user.
#pragma once

#include "app/csv.hpp"
#include "fe/solver/solver.hpp"

#include <array>
#include <string>
#include <vector>

namespace verification {

// Columns of STEM_cost.csv. Times are the only numbers of a run that a repetition does not repeat.
std::vector<std::string> cost_columns();

class CostReport {
 public:
  // The clock starts here. The solver must outlive it.
  explicit CostReport(const Solver& solver);

  // One row: what was spent since the last one.
  void add(const LoadStep& step, CsvWriter& table);
  // The same of a step that did not end, whose points are as they were.
  void add_unfinished(int step, const Effort& effort, CsvWriter& table);

 private:
  struct Reading {
    Spent total;
    std::array<Spent, stages> stage;
  };
  [[nodiscard]] Reading now() const;
  void add(int step, const Effort& effort, CsvWriter& table);

  const Solver& solver_;
  Reading last_;
  int without_contacts_ = 0;  // points, after the last step
};

// Of a whole table: cost per point and load step, where the time went, what it took. Lines, each with
// its end.
std::string cost_summary(const CsvTable& table, std::size_t points);

}  // namespace verification

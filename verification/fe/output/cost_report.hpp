// Cost of the load steps of a run: a table, and its summary.
#pragma once

#include "app/csv.hpp"
#include "fe/solver/solver.hpp"

#include <array>
#include <string>
#include <vector>

namespace verification {

// Columns of STEM_cost.csv. Times are the only numbers of a run that are not reproducible.
std::vector<std::string> cost_columns();
// Name among the fields of `every_point`, and columns of STEM_every_cost.csv.
inline constexpr const char* point_cost = "cost";
std::vector<std::string> point_cost_columns(std::size_t points);

class CostReport {
 public:
  // Starts the clock. `solver` must outlive the report. `points`: a table of point_cost_columns for
  // the time of every point, or null.
  explicit CostReport(const Solver& solver, CsvWriter* points = nullptr);

  // Adds a row: cost since the last one.
  void add(const LoadStep& step, CsvWriter& table);
  // Adds the row of a failed step, whose points are unchanged.
  void add_unfinished(int step, const Effort& effort, CsvWriter& table);

 private:
  struct Reading {
    Spent total;
    std::array<Spent, stages> stage;
    std::vector<double> points;  // [s]
  };
  [[nodiscard]] Reading now() const;
  void add(int step, const Effort& effort, CsvWriter& table);

  const Solver& solver_;
  CsvWriter* points_;
  Reading last_;
  int without_contacts_ = 0;  // points, after the last step
};

// Lines about a table: cost per point and load step, time by stages, totals.
std::string cost_summary(const CsvTable& table, std::size_t points);

}  // namespace verification

// The files of a run, written step by step.
#pragma once

#include "fe/output/cost_report.hpp"
#include "fe/output/run_tables.hpp"
#include "fe/output/vtk_series.hpp"
#include "fe/scene.hpp"

#include <string>
#include <vector>

namespace verification {

class RunOutput {
 public:
  // Opens the tables. Scene and solver must outlive it. Errors as RunTables has them.
  RunOutput(const FiniteElementScene& scene, RunTables tables, const Solver& solver);

  // `ends_before`: the last step of a run that ends before the scene's number of steps; it is drawn.
  void add(const LoadStep& step, bool ends_before = false);
  // Draws what shows the whole run.
  void finish() const;

  void save_tables(CheckpointWriter& out) const { tables_.save(out); }
  void save(CheckpointWriter& out) const { series_.save(out); }
  void restore(CheckpointReader& in) { series_.restore(in); }

  // For the user: what the run took, and which files there are.
  [[nodiscard]] std::string summary() const;
  [[nodiscard]] std::string written() const;

 private:
  void write(const LoadStep& step, bool ends_before);
  void add_point(std::size_t point, const LoadStep& step, CsvWriter& table) const;
  void draw(const LoadStep& step) const;

  const FiniteElementScene& scene_;
  const Solver& solver_;
  RunTables tables_;
  CsvWriter& history_;
  CsvWriter& newton_;
  CsvWriter& forces_;
  CsvWriter& costs_;
  CostReport cost_;
  CsvWriter* energies_ = nullptr;  // of dynamic runs
  CsvWriter* probes_ = nullptr;    // of scenes with probes
  std::vector<CsvWriter*> points_;
  std::vector<CsvWriter*> every_point_;
  VtkSeries series_;
};

}  // namespace verification

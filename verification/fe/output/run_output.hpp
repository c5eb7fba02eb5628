// Files of a run, written step by step.
#pragma once

#include "app/output.hpp"
#include "app/written.hpp"
#include "fe/output/cost_report.hpp"
#include "fe/output/run_tables.hpp"
#include "fe/output/vtk_series.hpp"
#include "fe/scene.hpp"

#include <string>
#include <vector>

namespace verification {

// All that a run of the scene can write; of one that goes on from its checkpoint, what that does not
// vouch for.
Outputs outputs_of(const FiniteElementScene& scene, bool goes_on);

class RunOutput {
 public:
  // Opens the tables. Scene and solver must outlive it. Throws as RunTables does.
  RunOutput(const FiniteElementScene& scene, RunTables tables, const Solver& solver);

  // Adds a step. `ends_before`: the last step of a run that ends early; it is drawn.
  void add(const LoadStep& step, bool ends_before = false);
  // Adds the effort of a failed step.
  void add_unfinished(int step, const Effort& effort);
  // Draws the pictures of the whole run.
  void finish();

  void save_tables(CheckpointWriter& out) const { tables_.save(out); }
  void save(CheckpointWriter& out) const { series_.save(out); }
  void restore(CheckpointReader& in) { series_.restore(in); }

  // Cost and files of the run, for the user.
  [[nodiscard]] std::string summary(const Effort& unfinished) const;
  [[nodiscard]] std::string written() const { return written_.text(); }

 private:
  CsvWriter& open(const std::string& suffix, const std::vector<std::string>& columns,
                  const char* shown = nullptr);
  void write(const LoadStep& step, bool ends_before);
  void add_point(std::size_t point, const LoadStep& step, CsvWriter& table) const;
  void draw(const LoadStep& step);

  const FiniteElementScene& scene_;
  const Solver& solver_;
  RunTables tables_;
  Written written_;
  bool drag_;
  CsvWriter& history_;
  CsvWriter& newton_;
  CsvWriter& forces_;
  CsvWriter& costs_;
  CostReport cost_;
  CsvWriter* energies_ = nullptr;  // dynamic runs
  CsvWriter* balance_ = nullptr;   // static runs
  CsvWriter* probes_ = nullptr;    // scenes with probes
  std::vector<CsvWriter*> points_;
  std::vector<CsvWriter*> every_point_;
  VtkSeries series_;
};

}  // namespace verification

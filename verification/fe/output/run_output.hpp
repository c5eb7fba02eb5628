// The files of a run, written step by step.
#pragma once

#include "fe/output/run_tables.hpp"
#include "fe/scene.hpp"

#include <string>

namespace verification {

class RunOutput {
 public:
  // Opens the tables. The scene must outlive it. Errors as RunTables has them.
  RunOutput(const FiniteElementScene& scene, RunTables tables, const Solver& solver);

  void add(const LoadStep& step);
  // Draws what shows the whole run.
  void finish() const;

  void save_tables(CheckpointWriter& out) const { tables_.save(out); }
  void save(CheckpointWriter& out) const;
  void restore(CheckpointReader& in);

  // For the user: what the run took, and which files there are.
  [[nodiscard]] std::string history() const;
  [[nodiscard]] std::string written() const;

 private:
  const FiniteElementScene& scene_;
  const Solver& solver_;
  RunTables tables_;
  CsvWriter& history_;
  CsvWriter& newton_;
  CsvWriter& forces_;
};

}  // namespace verification

// The tables of a run, which a restart continues where the checkpoint left them.
#pragma once

#include "app/csv.hpp"
#include "fe/checkpoint.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace verification {

class RunTables {
 public:
  explicit RunTables(std::filesystem::path stem) : stem_(std::move(stem)) {}
  // Of an interrupted run; the files themselves are not touched before `open`.
  RunTables(std::filesystem::path stem, CheckpointReader& in);

  // stem + suffix, e.g. "_force.csv"; continued when the run is. Errors as CsvWriter has them, and
  // InputError for a table that the interrupted run did not have. The reference stays valid.
  CsvWriter& open(const std::string& suffix, const std::vector<std::string>& columns);

  // Waits until the tables are on the disk, and says how long they are.
  void save(CheckpointWriter& out) const;

  [[nodiscard]] const std::filesystem::path& stem() const { return stem_; }

 private:
  std::filesystem::path stem_;
  bool continued_ = false;
  std::map<std::string, std::uint64_t> lengths_;  // of the interrupted run, by suffix
  std::map<std::string, CsvWriter> tables_;
};

}  // namespace verification

// Tables of a run, continued by a restart from the checkpoint.
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
  // Tables of an interrupted run; files are unchanged until `open`.
  RunTables(std::filesystem::path stem, CheckpointReader& in);

  // Opens stem + suffix, e.g. "_force.csv", or continues it. Throws as CsvWriter does, and
  // InputError for a table that the interrupted run lacked. The reference stays valid.
  CsvWriter& open(const std::string& suffix, const std::vector<std::string>& columns);

  // Waits until the tables are on disk, and saves their lengths.
  void save(CheckpointWriter& out) const;

  [[nodiscard]] const std::filesystem::path& stem() const { return stem_; }

 private:
  std::filesystem::path stem_;
  bool continued_ = false;
  std::map<std::string, std::uint64_t> lengths_;  // tables of the interrupted run, by suffix
  std::map<std::string, CsvWriter> tables_;
};

}  // namespace verification

#include "fe/output/run_tables.hpp"

#include "app/atomic_file.hpp"

#include <fmt/format.h>

namespace verification {

RunTables::RunTables(std::filesystem::path stem, CheckpointReader& in)
    : stem_(std::move(stem)), continued_(true) {
  const auto count = in.get<std::uint64_t>();
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto suffix = in.get<std::string>();
    in.read(lengths_[suffix]);
  }
}

CsvWriter& RunTables::open(const std::string& suffix, const std::vector<std::string>& columns) {
  const std::filesystem::path path = stem_.string() + suffix;
  if (!continued_) return tables_.try_emplace(suffix, path, columns).first->second;
  const auto length = lengths_.find(suffix);
  if (length == lengths_.end())
    throw InputError(fmt::format("{}: the interrupted run has no such table", path.string()));
  return tables_.try_emplace(suffix, path, columns, length->second).first->second;
}

void RunTables::save(CheckpointWriter& out) const {
  out.write(static_cast<std::uint64_t>(tables_.size()));
  for (const auto& [suffix, table] : tables_) {
    sync_file(table.path());
    out.write(suffix);
    out.write(static_cast<std::uint64_t>(table.length()));
  }
}

}  // namespace verification

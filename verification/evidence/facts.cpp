#include "evidence/facts.hpp"

#include "app/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace verification {
namespace {

// Second field of the line that begins with this one.
std::string told(const std::filesystem::path& machine, const std::string& wanted) {
  std::ifstream file(machine);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(wanted + ",")) return line.substr(wanted.size() + 1);
  return "unknown";
}

}  // namespace

void Facts::add(const std::string& name, double value) {
  if (std::isfinite(value)) values_.emplace_back(head_ + "." + name, value);
}

void Facts::write(const std::filesystem::path& directory) const {
  const std::filesystem::path machine = directory / "machine.csv";
  const std::string commit = told(machine, "revision"), processor = told(machine, "processor");
  Table table("Facts", {"fact", "value", "commit", "machine"});
  for (const auto& [name, value] : values_)
    table.row({name, fmt::format("{:.10g}", value), commit, processor});
  table.print();
  table.write(directory / (head_ + "_facts.csv"));
}

}  // namespace verification

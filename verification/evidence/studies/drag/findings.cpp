#include "evidence/studies/drag/findings.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace verification::drag {
namespace {

// "order[-]" -> "order" and "[-]".
std::pair<std::string, std::string> parts_of(const std::string& column) {
  const auto unit = column.find('[');
  return {column.substr(0, unit), column.substr(unit)};
}

std::vector<std::string> columns_of(std::vector<std::string> facts,
                                    const std::vector<Claim>& claims) {
  for (const Claim& claim : claims) {
    const auto [name, unit] = parts_of(claim.name);
    facts.push_back(claim.name);
    facts.push_back(name + (claim.at_least ? "_at_least" : "_at_most") + unit);
  }
  facts.emplace_back("end");
  return facts;
}

}  // namespace

Findings::Findings(const StudyOptions& options, const std::string& section,
                   const std::string& title, std::vector<std::string> facts,
                   std::vector<Claim> claims)
    : section_(section),
      path_(std::filesystem::path(options.output) / fmt::format("study_drag_{}.csv", section)),
      claims_(std::move(claims)),
      table_(title, columns_of(std::move(facts), claims_)) {}

void Findings::row(std::vector<Table::Cell> facts, const std::vector<Found>& found) {
  std::string failed;
  bool bounded = false;
  const std::string name = facts.front().shown + ", " + facts.at(1).shown;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto [value, bound] = found[k];
    facts.emplace_back(value);
    facts.emplace_back(std::isnan(bound) ? Table::Cell("") : Table::Cell(bound));
    if (std::isnan(bound)) continue;
    bounded = true;
    const bool holds = claims_.at(k).at_least ? value >= bound : value <= bound;
    if (!holds) failed += (failed.empty() ? "fails: " : " ") + parts_of(claims_[k].name).first;
  }
  compared_ += bounded ? 1 : 0;
  agreed_ += bounded && failed.empty() ? 1 : 0;
  const std::string end = !bounded ? "told" : failed.empty() ? "holds" : failed;
  facts.emplace_back(end);
  table_.row(facts);
  table_.write(path_);
  tell(fmt::format("{}: {}: {}\n", section_, name, end));
}

void Findings::print() const {
  table_.print();
  fmt::print("{}: {} of {} rows agree with their bounds\n", section_, agreed_, compared_);
}

}  // namespace verification::drag

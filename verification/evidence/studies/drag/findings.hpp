// What a section of the study found: facts of each case, and numbers beside bounds set beforehand.
#pragma once

#include "evidence/studies/study.hpp"

#include "app/table.hpp"

#include <limits>
#include <string>
#include <vector>

namespace verification::drag {

inline constexpr double told =
    std::numeric_limits<double>::quiet_NaN();  // a number without a bound

// A number that is compared with a bound in every row, "name[unit]".
struct Claim {
  std::string name;
  bool at_least = false;  // the bound is a lower one
};

struct Found {
  double value;
  double bound = told;
};

// A table with a row for each case, whose last column says "holds", "fails: WHAT", or "told". It
// is written anew with every row, so that an interrupted section keeps its rows.
class Findings {
 public:
  // The table goes to study_drag_SECTION.csv.
  Findings(const StudyOptions& options, const std::string& section, const std::string& title,
           std::vector<std::string> facts, std::vector<Claim> claims);

  void row(std::vector<Table::Cell> facts, const std::vector<Found>& found);
  void print() const;

 private:
  std::string section_;
  std::filesystem::path path_;
  std::vector<Claim> claims_;
  Table table_;
  int compared_ = 0, agreed_ = 0;
};

}  // namespace verification::drag

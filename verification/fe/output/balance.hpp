// How well every load step of a static run is balanced, and what that took.
#pragma once

#include "app/csv.hpp"
#include "fe/solver/solver.hpp"

#include <string>
#include <vector>

namespace verification {

// Columns of STEM_balance.csv.
std::vector<std::string> balance_columns();
std::vector<double> balance_values(const LoadStep& step);

// Of a whole table: steps that are balanced, the worst, percentiles of the iterations. One line with
// its end; none of a table without load steps.
std::string balance_summary(const CsvTable& table);

}  // namespace verification

// Balance of every load step of a static run, and its effort.
#pragma once

#include "app/csv.hpp"
#include "fe/solver/solver.hpp"

#include <string>
#include <vector>

namespace verification {

// Columns of STEM_balance.csv.
std::vector<std::string> balance_columns();
std::vector<double> balance_values(const LoadStep& step);

// One line about a table: balanced steps, the worst, percentiles of the iterations. Empty for a
// table without load steps.
std::string balance_summary(const CsvTable& table);

}  // namespace verification

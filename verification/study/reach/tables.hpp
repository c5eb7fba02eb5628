// What came of the increments: shares against the bars, cost, and every exception.
#pragma once

#include "study/reach/paths.hpp"

#include <filesystem>
#include <vector>

namespace verification::reach {

// Prints and writes reach.csv, reach_groups.csv and reach_rest.csv. Throws ComputationError.
void tabulate(const std::vector<Path>& paths, double tolerance,
              const std::filesystem::path& output);

}  // namespace verification::reach

// What came of the increments: shares against the bars, cost, and every exception.
#pragma once

#include "evidence/studies/reach/paths.hpp"

#include <filesystem>
#include <vector>

namespace verification::reach {

// Prints and writes reach.csv, reach_groups.csv and reach_rest.csv. Throws ComputationError.
void tabulate(const std::vector<Path>& paths, double tolerance,
              const std::filesystem::path& output);

// Means over repeats of the same paths, and the standard errors of these means, to reach_repeats.csv.
// Throws ComputationError.
void tabulate_repeats(const std::vector<std::vector<Path>>& repeats, double tolerance,
                      const std::filesystem::path& output);

}  // namespace verification::reach

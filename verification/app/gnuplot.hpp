// Runs of gnuplot, independent of the user's settings and working directory.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// Runs `body` for stem.svg and for stem.png, each width x height points, in a plain style. Without
// gnuplot prints a note to stderr and returns false. Throws ComputationError when a picture cannot
// be written.
bool run_gnuplot(const std::string& body, const std::filesystem::path& stem, int width, int height);

}  // namespace verification

// Pictures drawn by gnuplot, whose own settings and directory of work change nothing in them.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// Runs `body` once for stem.svg and once for stem.png, each of width x height points, with a plain
// style set up. Without gnuplot says so on stderr and returns false; the tables are complete without
// pictures. Throws ComputationError when a picture cannot be written.
bool run_gnuplot(const std::string& body, const std::filesystem::path& stem, int width, int height);

}  // namespace verification

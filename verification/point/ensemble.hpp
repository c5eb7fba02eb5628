// Cases that are many packings of one recipe: their mean and how far they spread.
#pragma once

#include "app/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// A case with `seeds`, and the names of its results.
struct Ensemble {
  std::string name;  // SCENE_CASE
  std::vector<std::string> members;
};

// Of a scene whose results begin with `prefix`: those with two seeds or more.
std::vector<Ensemble> ensembles_of(const SceneFile& file, const std::string& prefix);

// From the tables of the members in that directory, which have to be of this run: NAME_ensemble.csv, per step
// the number of runs that reached it, and of every column the mean and the standard deviation over these; and
// the same as curves in bands of one standard deviation in NAME_ensemble.svg, .png. Tells what it wrote.
// Members without a table are left out; fewer than two make no ensemble, and of an old one it says that it is.
void write_ensemble(const Ensemble& ensemble, const std::filesystem::path& directory,
                    const std::string& abscissa, bool figure);

}  // namespace verification

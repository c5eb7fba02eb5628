// Ensembles of packings from one recipe: mean and spread.
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

// Ensembles with at least two seeds in a scene whose results begin with `prefix`.
std::vector<Ensemble> ensembles_of(const SceneFile& file, const std::string& prefix);

// Writes NAME_ensemble.csv from this run's tables of the members: per step the number of runs that
// reached it, and mean and standard deviation of every column over these. NAME_ensemble.svg and
// .png show curves with bands of one standard deviation. Prints what it wrote. Members without a
// table are left out. With fewer than two nothing is written, and an old ensemble is reported as
// old.
void write_ensemble(const Ensemble& ensemble, const std::filesystem::path& directory,
                    const std::string& abscissa, bool figure);

}  // namespace verification

// Scenes that vary one thing at a time: `[[case]]` tables laid over the rest of the file.
#pragma once

#include "app/scene.hpp"

#include <vector>

namespace verification {

// The scene of every case, key by key over the rest and named SCENE_CASE; none without cases, for a
// copy of a table no longer knows its lines. A case with `seeds` = N stands for N of them, SCENE_CASE_sK
// with material.packing.seed = K. Throws InputError for a case without a name.
std::vector<toml::table> scene_cases(const SceneFile& file);

}  // namespace verification

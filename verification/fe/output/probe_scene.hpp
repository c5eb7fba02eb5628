// Probes in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/output/probe.hpp"

namespace verification {

// Reads `name` and one of: `on`, a set of nodes; `x`, `y` or `z` [m], the nodes at
// this coordinate of the undeformed mesh. Throws InputError.
DisplacementProbe read_probe(SceneTable& table, const Mesh& mesh);

}  // namespace verification

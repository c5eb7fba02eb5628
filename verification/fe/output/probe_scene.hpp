// Probes in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/output/probe.hpp"

namespace verification {

// Reads `name` and one of: `on`, a set of nodes; `x` or `y` [m], the nodes on this line of the
// undeformed mesh. Throws InputError.
DisplacementProbe read_probe(SceneTable& table, const Mesh& mesh);

}  // namespace verification

// Checks of a packing whose files are readable.
#pragma once

#include "frame/frame_rows.hpp"
#include "packing/packing.hpp"

#include <string>
#include <vector>

namespace grainlaw::core {

// Fails for particles whose centres lie inside one another: their lengths have different units.
// Pairs named as contacts are exempt, since their forces tell. Boundary particles of a deformed
// frame are too, since a rigid row has no contacts within. Throws Error (BAD_PACKING) that begins
// with the path.
template <int D>
void check_sizes(const std::string& path, const ParticleIds& ids, const Packing& packing);

// Fails for contacts, from these lines of their file, between particles that do not touch. Bonds
// may be stretched; their forces are checked elsewhere. Throws as above.
template <int D>
void check_branches(const std::string& path, const std::vector<unsigned>& lines,
                    const Packing& packing);

}  // namespace grainlaw::core

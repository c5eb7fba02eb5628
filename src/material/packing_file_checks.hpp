// What is wrong with a packing although every number of its files can be read.
#pragma once

#include "frame/frame_rows.hpp"
#include "packing/packing.hpp"

#include <string>
#include <vector>

namespace grainlaw::core {

// Particles whose centres lie in one another are no packing, but lengths in different units; unless
// they are named as contacts, whose forces tell, or those of a boundary that was deformed, of which
// a rigid row does not feel each other. Throws Error (BAD_PACKING) that begins with the path.
template <int D>
void check_sizes(const std::string& path, const ParticleIds& ids, const Packing& packing);

// Contacts join particles that touch, and have these lines in their file. Bonds stretch as far as they
// hold: whether they do is seen by their forces. Throws as above.
template <int D>
void check_branches(const std::string& path, const std::vector<unsigned>& lines,
                    const Packing& packing);

}  // namespace grainlaw::core

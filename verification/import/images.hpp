// Which image of a particle a contact is with.
#pragma once

#include "import/foreign_packing.hpp"

#include <array>
#include <optional>
#include <vector>

namespace verification {

using Shift = std::array<int, 3>;

// Images of j within twice the sum of radii: those that touch i, or else the nearest. A particle
// touches its own image on two opposite sides, of which one is taken.
std::vector<Shift> images_in_touch(const ForeignPacking& packing, std::size_t i, std::size_t j);

// The one whose branch is `apart` or its opposite; nothing where none or two are.
std::optional<Shift> image_apart(const ForeignPacking& packing, std::size_t i, std::size_t j,
                                 const std::vector<Shift>& images, const Position& apart);

}  // namespace verification

// Which image of a particle a contact is with.
#pragma once

#include "import/foreign_packing.hpp"

#include <array>
#include <optional>
#include <vector>

namespace verification {

using Shift = std::array<int, 3>;

// Of the images of j within twice the sum of radii, those that touch i, or else the nearest. Of two
// sides of one particle's contact with its own image the first.
std::vector<Shift> images_in_touch(const ForeignPacking& packing, std::size_t i, std::size_t j);

// The one whose branch is `apart` or its opposite; nothing where none or two are.
std::optional<Shift> image_apart(const ForeignPacking& packing, std::size_t i, std::size_t j,
                                 const std::vector<Shift>& images, const Place& apart);

}  // namespace verification

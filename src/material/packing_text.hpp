// A packing as the text of its three files, numbers in the shortest digits that read back to the
// same bits.
#pragma once

#include "packing/packing.hpp"

#include <string>

namespace grainlaw::core {

std::string particles_text(const Packing& packing);
std::string contacts_text(const Packing& packing);
std::string cell_text(const Packing& packing);

}  // namespace grainlaw::core

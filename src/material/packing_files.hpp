// The three files of a packing as texts, read by dimension.
#pragma once

#include "packing/packing.hpp"

#include <string>

namespace grainlaw::core {

// One of the three files; without a path it is not there.
struct PackingText {
  std::string path;
  std::string text;
};

struct PackingTexts {
  PackingText particles, contacts, cell;
};

// Throw Error (BAD_PACKING) as read_packing().
Packing read_plane_packing(const PackingTexts& texts);
Packing read_space_packing(const PackingTexts& texts);

}  // namespace grainlaw::core

// The three files of a packing as texts, with one reader per dimension.
#pragma once

#include "packing/packing.hpp"

#include <string>

namespace grainlaw::core {

// One of the three files; absent when its path is empty.
struct PackingText {
  std::string path;
  std::string text;
};

struct PackingTexts {
  PackingText particles, contacts, cell;
};

// Readers per dimension; throw Error (BAD_PACKING) as read_packing() does.
Packing read_plane_packing(const PackingTexts& texts);
Packing read_space_packing(const PackingTexts& texts);

}  // namespace grainlaw::core

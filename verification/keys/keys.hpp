// Keys of material files and scenes, as their readers ask for them.
#pragma once

#include "io/toml_table.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

// Unit and meaning of a key, which no reader knows.
struct KeyText {
  std::string_view path;
  std::string_view unit;
  std::string_view meaning;
};

// A key with all its data; unit and meaning are empty where they are not documented.
struct Key {
  grainlaw::core::AskedKey asked;
  std::string_view unit;
  std::string_view meaning;
};

// All keys of a material file in the order of reading, logged over examples that together ask for
// every key. Throws std::logic_error for a key without a text, and for a text without a key.
std::vector<Key> material_keys();
// All keys of a command's scenes: point, solve, dns or wave. Texts
// come from verification/scenes/README.md. Throws InputError for another command.
std::vector<Key> scene_keys(std::string_view command);

std::span<const KeyText> material_key_texts();

// Page table of columns (NAME.csv), balance (NAME_balance.csv), measures or statuses; "" for any
// other name.
std::string result_table(std::string_view what);

// Text escaped for a table of a page.
std::string as_cell(std::string_view text);

}  // namespace verification

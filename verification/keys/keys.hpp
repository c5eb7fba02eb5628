// The keys of material files and scenes, as the readers themselves ask for them.
#pragma once

#include "io/toml_table.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

// What a reader cannot tell of a key: its unit and what it means.
struct KeyText {
  std::string_view path;
  std::string_view unit;
  std::string_view meaning;
};

// A key with all that is known of it; unit and meaning are empty where nobody wrote them down.
struct Key {
  grainlaw::core::AskedKey asked;
  std::string_view unit;
  std::string_view meaning;
};

// All keys of a material file, in the order in which they are read: the log of examples that together
// ask for every key, with its texts. Throws std::logic_error for a key without a text, and for a text
// whose key nobody asks for.
std::vector<Key> material_keys();
// All keys of the scenes of a command: point, solve, bricks (solve with spheres), dns or wave. Their
// texts are those of verification/scenes/README.md. Throws InputError for another command.
std::vector<Key> scene_keys(std::string_view command);

std::span<const KeyText> material_key_texts();

// Of columns (of NAME.csv), balance (NAME_balance.csv), measures or statuses, as a table of a page; "" for
// anything else.
std::string result_table(std::string_view what);

// A text in a table of a page.
std::string as_cell(std::string_view text);

}  // namespace verification

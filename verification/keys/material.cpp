#include "app/library.hpp"
#include "keys/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace verification {
namespace {

std::vector<grainlaw::core::AskedKey> asked_keys() {
  std::size_t size = 0;
  check(grainlaw_material_keys(nullptr, &size), "sizing the keys of material files");
  std::string text(size, '\0');
  check(grainlaw_material_keys(text.data(), &size), "listing the keys of material files");
  std::istringstream lines(text.substr(0, size - 1));
  std::vector<grainlaw::core::AskedKey> keys;
  for (grainlaw::core::AskedKey key; std::getline(lines, key.path, '\t');) {
    std::getline(lines, key.expected, '\t');
    std::getline(lines, key.fallback);
    keys.push_back(key);
  }
  return keys;
}

}  // namespace

std::vector<Key> material_keys() {
  std::vector<Key> keys;
  const auto texts = material_key_texts();
  for (const grainlaw::core::AskedKey& key : asked_keys()) {
    const auto text =
        std::ranges::find_if(texts, [&](const KeyText& other) { return other.path == key.path; });
    if (text == texts.end())
      throw std::logic_error(fmt::format("the key {} of a material file has no text", key.path));
    keys.push_back({key, text->unit, text->meaning});
  }
  for (const KeyText& text : texts)
    if (std::ranges::none_of(keys, [&](const Key& key) { return key.asked.path == text.path; }))
      throw std::logic_error(
          fmt::format("nobody asks for the key {} of a material file", text.path));
  return keys;
}

}  // namespace verification

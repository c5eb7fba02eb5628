// What a reader asks a material file for, as the pages of keys have it.
#include "material/material_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace grainlaw::core;

namespace {

AskedKey find(const KeyLog& log, std::string_view path) {
  const auto found = std::ranges::find(log, path, &AskedKey::path);
  return found == log.end() ? AskedKey{} : *found;
}

KeyLog log_of_a_recipe() {
  KeyLog log;
  static_cast<void>(parse_material(R"(
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 10, radii = [1, 2], seed = 1, pressure = 1 }
contact = { law = "frictional", kn = 1e4, ratio = 0.2, friction = 0.4 }
)",
                                   "", "recipe", &log));
  return log;
}

}  // namespace

TEST(key_log, has_range_and_default_of_a_number) {
  const AskedKey key = find(log_of_a_recipe(), "boundary.servo.inheritance");
  EXPECT_EQ(key.expected, "a number from 0 to 1");
  EXPECT_EQ(key.fallback, "1");
}

TEST(key_log, has_words_and_the_word_of_the_default) {
  const AskedKey key = find(log_of_a_recipe(), "solver.start");
  EXPECT_EQ(key.expected, "one of \"committed\", \"trial\"");
  EXPECT_EQ(key.fallback, "\"committed\"");
}

TEST(key_log, tells_keys_that_are_required_and_keys_of_which_one_is) {
  const KeyLog log = log_of_a_recipe();
  EXPECT_EQ(find(log, "packing.count").fallback, "required");
  EXPECT_EQ(find(log, "contact.kn").fallback, "this or young");
  EXPECT_EQ(find(log, "contact.young").expected, "a number > 0");
}

TEST(key_log, has_a_key_once) {
  KeyLog log = log_of_a_recipe();
  std::ranges::sort(log, {}, &AskedKey::path);
  EXPECT_EQ(std::ranges::adjacent_find(log, {}, &AskedKey::path), log.end());
}

// Scene files: TOML in which every key is checked.
#pragma once

#include "app/library.hpp"
#include "io/toml_table.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

// Bounds of a number, with their text for messages.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;  // low itself is excluded
  std::string_view text = "a number";
};
inline constexpr Range any_number{};
inline constexpr Range positive{0, std::numeric_limits<double>::infinity(), true, "a number > 0"};
inline constexpr Range not_negative{0, std::numeric_limits<double>::infinity(), false,
                                    "a number >= 0"};

// A table of a scene file: that of src/io with errors of the program. Keys that were asked for are
// known; close() refuses others. All functions throw InputError "file:line: key: found X, expected
// Y".
class SceneTable {
 public:
  // `name` is the table's name in messages, "" for the root; `table` must outlive this object.
  SceneTable(const toml::table& table, std::filesystem::path file, const std::string& name,
             grainlaw::core::KeyLog* log = nullptr);

  bool has(std::string_view key) { return node(key) != nullptr; }

  double number(std::string_view key, const Range& range = any_number);
  double number_or(std::string_view key, double fallback, const Range& range = any_number);
  int integer(std::string_view key, int low);
  int integer_or(std::string_view key, int fallback, int low,
                 int high = std::numeric_limits<int>::max());
  bool flag_or(std::string_view key, bool fallback);
  std::string text(std::string_view key);
  std::string text_or(std::string_view key, std::string_view fallback);
  // A text that becomes part of file names.
  std::string file_name(std::string_view key);
  std::string file_name_or(std::string_view key, std::string_view fallback);
  std::string choice_or(std::string_view key, std::string_view fallback,
                        const std::vector<std::string_view>& choices);
  // Exactly `count` numbers.
  std::vector<double> numbers(std::string_view key, std::size_t count, const Range& range);
  // A sub-table; an array of tables ([[key]]; absent: empty).
  SceneTable table(std::string_view key);
  std::vector<SceneTable> tables(std::string_view key);
  // Node of a key whose value is passed on; null when absent.
  const toml::node* node(std::string_view key) { return table_.node(key); }

  // Throws for the first unknown key; call it after all keys were asked for.
  void close() const;

  // Throws InputError at the line of the key, or of the table when the key is absent, with a
  // similar key as a hint.
  [[noreturn]] void fail(std::string_view key, std::string_view found,
                         std::string_view expected) const;
  // "file:line: name", for messages about the whole table.
  [[nodiscard]] std::string place() const { return table_.place(); }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] const toml::table& content() const { return table_.content(); }

 private:
  SceneTable(grainlaw::core::TomlTable table, std::filesystem::path file);
  template <class T>
  T required(std::string_view key, const grainlaw::core::Expectation<T>& expectation);
  template <class T, class Shown>
  T optional(std::string_view key, const grainlaw::core::Expectation<T>& expectation,
             const Shown& fallback);

  grainlaw::core::TomlTable table_;
  std::filesystem::path file_;
};

// A parsed scene file, which tables refer to.
struct SceneFile {
  explicit SceneFile(const std::filesystem::path& path);  // throws InputError
  SceneFile(std::filesystem::path path, toml::table content);

  std::filesystem::path path;
  toml::table content;
  grainlaw::core::KeyLog* log = nullptr;  // keys asked for in the root and its tables

  [[nodiscard]] SceneTable root() const { return {content, path, "", log}; }
};

}  // namespace verification

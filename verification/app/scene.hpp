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

// Bounds of a number; `text` says them to a person.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;  // low itself is outside
  std::string_view text = "a number";
};
inline constexpr Range any_number{};
inline constexpr Range positive{0, std::numeric_limits<double>::infinity(), true, "a number > 0"};
inline constexpr Range not_negative{0, std::numeric_limits<double>::infinity(), false,
                                    "a number >= 0"};

// A table of a scene file: src/io's, with errors of the program. Every key that is asked for counts as
// known; close() refuses the rest. All functions throw InputError "file:line: key: found X, expected Y".
class SceneTable {
 public:
  // The table that messages call by this name, "" for the root. It must outlive this.
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
  // Becomes part of the names of files.
  std::string file_name(std::string_view key);
  std::string file_name_or(std::string_view key, std::string_view fallback);
  std::string choice_or(std::string_view key, std::string_view fallback,
                        const std::vector<std::string_view>& choices);
  // Exactly `count` numbers.
  std::vector<double> numbers(std::string_view key, std::size_t count, const Range& range);
  // A sub-table, and an array of tables ([[key]]; absent: empty).
  SceneTable table(std::string_view key);
  std::vector<SceneTable> tables(std::string_view key);
  // The value itself, for keys that are passed on; null when absent.
  const toml::node* node(std::string_view key) { return table_.node(key); }

  // To be called when everything was asked for. Throws for the first key that nobody knows.
  void close() const;

  // Throws InputError at the line of the key, or of the table when the key is absent; then with the
  // key that may have been meant for it.
  [[noreturn]] void fail(std::string_view key, std::string_view found,
                         std::string_view expected) const;
  // "file:line: name", for messages about what the table as a whole says.
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

// A parsed scene file; SceneTable points into it.
struct SceneFile {
  explicit SceneFile(const std::filesystem::path& path);  // throws InputError
  SceneFile(std::filesystem::path path, toml::table content);

  std::filesystem::path path;
  toml::table content;
  grainlaw::core::KeyLog* log = nullptr;  // of the keys that the root and its tables are asked for

  [[nodiscard]] SceneTable root() const { return {content, path, "", log}; }
};

}  // namespace verification

// A TOML table in which every key is checked and no key is ignored.
#pragma once

#include "io/toml.hpp"

#include <array>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace grainlaw::core {

// An expected value: a text for messages ("a number > 0") and a reader. read() returns nothing for
// any other value.
template <class T>
struct Expectation {
  std::string text;
  std::function<std::optional<T>(const toml::node&)> read;
};

// Finite numbers, integers included.
Expectation<double> any_number();
Expectation<double> number_above(double low);
Expectation<double> number_at_least(double low);
Expectation<double> number_between(double low, double high);      // both included
Expectation<double> number_above_up_to(double low, double high);  // low excluded
Expectation<long> integer_between(long low, long high = std::numeric_limits<long>::max());
Expectation<bool> boolean();
Expectation<std::string> text(std::string meaning);
// [smallest, largest] with 0 < smallest <= largest.
Expectation<std::array<double, 2>> positive_range();
Expectation<std::array<long, 3>> three_integers_between(long low, long high);
// Three finite numbers, not all zero.
Expectation<std::array<double, 3>> direction();

// One of several words, each with its value.
template <class T>
Expectation<T> one_of(std::initializer_list<std::pair<std::string_view, T>> words) {
  std::string expected = words.size() > 1 ? "one of" : "";
  for (const auto& word : words) {
    if (!expected.empty()) expected += word.first == words.begin()->first ? " " : ", ";
    expected += '"' + std::string(word.first) + '"';
  }
  return {expected, [allowed = std::vector(words)](const toml::node& node) -> std::optional<T> {
            const auto found = node.value_exact<std::string_view>();
            for (const auto& word : allowed)
              if (found == word.first) return word.second;
            return std::nullopt;
          }};
}

// A key that a reader asked for: a row of the manual's table of keys.
struct AskedKey {
  std::string path;      // "contact.kn"; "segment[].steps" under [[segment]]
  std::string expected;  // text of the expectation
  std::string fallback;  // "required", a value, or "" for none
};
using KeyLog = std::vector<AskedKey>;

// Default value as a page shows it.
std::string shown(double value);
std::string shown(bool value);
std::string shown(int value);
inline std::string shown(std::string_view value) { return std::string(value); }
// The word of an expectation that stands for the value; "" when none does.
template <class U, class T>
std::string shown_default(const Expectation<U>& expectation, const T& value) {
  if constexpr (std::is_same_v<U, bool>)
    return shown(static_cast<bool>(value));
  else if constexpr (std::is_arithmetic_v<U>)
    return shown(static_cast<double>(value));
  else if constexpr (std::is_enum_v<U>) {
    for (std::size_t begin = expectation.text.find('"'); begin != std::string::npos;) {
      const std::size_t end = expectation.text.find('"', begin + 1);
      const std::string word = expectation.text.substr(begin + 1, end - begin - 1);
      if (expectation.read(toml::value<std::string>(word)) == static_cast<U>(value))
        return '"' + word + '"';
      begin = expectation.text.find('"', end + 1);
    }
  }
  return "";
}

// Parses the whole text of a file; `name` appears in messages. Throws Error (BAD_MATERIAL)
// "name:line: what is wrong".
toml::table parse_toml(std::string_view text, const std::string& name);

// A checked table. Every failure is an Error (BAD_MATERIAL) with the text
//   file:line: table.key: found X, expected Y
class TomlTable {
 public:
  // `name` is the table's name in messages, "" for the top one; `file` serves messages alone.
  // `table` must outlive this object. Keys asked for are appended to the log, where given.
  TomlTable(const toml::table& table, std::string file, const std::string& name = "",
            KeyLog* log = nullptr)
      : table_(&table),
        file_(std::move(file)),
        prefix_(name.empty() ? "" : name + '.'),
        log_(log) {}

  template <class T>
  T required(std::string_view key, const Expectation<T>& expectation) {
    note(key, expectation.text, "required");
    const toml::node* found = node(key);
    if (found == nullptr) fail(key, "nothing", expectation.text);
    return read(key, *found, expectation);
  }

  template <class T, class U>
  void required(std::string_view key, const Expectation<U>& expectation, T& value) {
    value = static_cast<T>(required(key, expectation));
  }

  // Value of a key; nothing when it is absent.
  template <class T>
  std::optional<T> optional(std::string_view key, const Expectation<T>& expectation) {
    note(key, expectation.text, "");
    const toml::node* found = node(key);
    if (found == nullptr) return std::nullopt;
    return read(key, *found, expectation);
  }

  // Sets `value` when the key is present.
  template <class T, class U>
  void optional(std::string_view key, const Expectation<U>& expectation, T& value) {
    if (log_ != nullptr) note(key, expectation.text, shown_default(expectation, value));
    if (const std::optional<U> found = optional(key, expectation)) value = static_cast<T>(*found);
  }

  // Node of a key whose value is passed on; null when absent.
  const toml::node* node(std::string_view key);
  // Tables under [[key]]; none when absent.
  std::vector<TomlTable> tables(std::string_view key);
  TomlTable required_table(std::string_view key);
  TomlTable optional_table(std::string_view key);  // empty when absent

  // Fails unless exactly one of the two keys is present.
  void require_either(std::string_view one, std::string_view other);

  // Logs a key; the first note of a key stays.
  void note(std::string_view key, std::string_view expected, std::string_view fallback) const {
    if (log_ != nullptr) write_note(key, expected, fallback);
  }

  // Fails for a key that no reader asked for.
  void finish() const;

  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
  [[nodiscard]] const toml::table& content() const { return *table_; }
  // "file:line: name", for messages about the whole table.
  [[nodiscard]] std::string place() const;
  // Value as messages show it.
  static std::string describe(const toml::node& node);
  // Throws at the line of the key, or of the table when it is missing, with a similar key as a
  // hint.
  [[noreturn]] void fail(std::string_view key, std::string_view found,
                         std::string_view expected) const;

 private:
  template <class T>
  T read(std::string_view key, const toml::node& found, const Expectation<T>& expectation) const {
    std::optional<T> value = expectation.read(found);
    if (!value) fail(key, describe(found), expectation.text);
    return std::move(*value);
  }

  void write_note(std::string_view key, std::string_view expected, std::string_view fallback) const;
  [[nodiscard]] TomlTable child(std::string_view key, const toml::node& node) const;
  [[nodiscard]] std::string path(std::string_view key) const;
  // "file:line" of the key, or of the table when the key is missing.
  [[nodiscard]] std::string where(std::string_view key) const;

  const toml::table* table_;
  std::string file_;
  std::string prefix_;              // "contact."
  std::vector<std::string> asked_;  // in the order of asking, for messages
  KeyLog* log_ = nullptr;
};

}  // namespace grainlaw::core

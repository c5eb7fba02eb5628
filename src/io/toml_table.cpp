#define TOML_IMPLEMENTATION
#include "io/toml_table.hpp"

#include "base/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace grainlaw::core {
namespace {

template <class Accept>
Expectation<double> number(std::string text, Accept accept) {
  return {std::move(text), [accept](const toml::node& node) -> std::optional<double> {
            if (!node.is_number()) return std::nullopt;
            const double value = node.value<double>().value_or(NAN);
            return std::isfinite(value) && accept(value) ? std::optional(value) : std::nullopt;
          }};
}

// Whether two words are probably one misspelt: they differ by at most two letters in one place.
bool resembles(std::string_view a, std::string_view b) {
  constexpr std::size_t slip = 2, in_common = 3;
  if (a.size() > b.size()) std::swap(a, b);
  std::size_t same = 0;
  while (same < a.size() && a[same] == b[same]) ++same;
  std::size_t end = 0;
  while (same + end < a.size() && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  return same + end >= in_common && b.size() - same - end <= slip;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& name) {
  // Exceptions, or a name to store, would end the process when memory is short.
  toml::parse_result parsed = toml::parse(text);
  if (!parsed)
    throw Error(GRAINLAW_BAD_MATERIAL,
                fmt::format("{}:{}: {}", name, parsed.error().source().begin.line,
                            parsed.error().description()));
  return std::move(parsed).table();
}

Expectation<double> any_number() {
  return number("a number", [](double) { return true; });
}

Expectation<double> number_above(double low) {
  return number(fmt::format("a number > {}", low), [=](double x) { return x > low; });
}

Expectation<double> number_at_least(double low) {
  return number(fmt::format("a number >= {}", low), [=](double x) { return x >= low; });
}

Expectation<double> number_between(double low, double high) {
  return number(fmt::format("a number from {} to {}", low, high),
                [=](double x) { return x >= low && x <= high; });
}

Expectation<double> number_above_up_to(double low, double high) {
  return number(fmt::format("a number > {} and <= {}", low, high),
                [=](double x) { return x > low && x <= high; });
}

Expectation<long> integer_between(long low, long high) {
  const bool bounded = high < std::numeric_limits<long>::max();
  return {bounded ? fmt::format("an integer from {} to {}", low, high)
                  : fmt::format("an integer >= {}", low),
          [=](const toml::node& node) -> std::optional<long> {
            const auto value = node.value_exact<std::int64_t>();
            if (!value || *value < low || *value > high) return std::nullopt;
            return static_cast<long>(*value);
          }};
}

Expectation<bool> boolean() {
  return {"true or false", [](const toml::node& node) { return node.value_exact<bool>(); }};
}

Expectation<std::string> text(std::string meaning) {
  return {std::move(meaning), [](const toml::node& node) {
            auto value = node.value_exact<std::string>();
            return value && !value->empty() ? value : std::nullopt;
          }};
}

Expectation<std::array<double, 2>> positive_range() {
  using Range = std::array<double, 2>;
  return {"[smallest, largest] with 0 < smallest <= largest",
          [](const toml::node& node) -> std::optional<Range> {
            const toml::array* array = node.as_array();
            if (array == nullptr || array->size() != 2) return std::nullopt;
            const auto positive = number_above(0);
            const auto smallest = positive.read((*array)[0]);
            const auto largest = positive.read((*array)[1]);
            if (!smallest || !largest || *smallest > *largest) return std::nullopt;
            return Range{*smallest, *largest};
          }};
}

namespace {

template <class T>
std::optional<std::array<T, 3>> read_three(const toml::node& node, const Expectation<T>& each) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 3) return std::nullopt;
  std::array<T, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = each.read((*array)[k]);
    if (!value) return std::nullopt;
    result[k] = *value;
  }
  return result;
}

}  // namespace

Expectation<std::array<long, 3>> three_integers_between(long low, long high) {
  return {fmt::format("three integers from {} to {}", low, high),
          [each = integer_between(low, high)](const toml::node& node) {
            return read_three(node, each);
          }};
}

Expectation<std::array<double, 3>> direction() {
  return {"three numbers, not all 0", [](const toml::node& node) {
            auto found = read_three(node, any_number());
            constexpr std::array<double, 3> none{};
            return found == none ? std::nullopt : found;
          }};
}

std::string shown(double value) { return fmt::format("{:g}", value); }
std::string shown(bool value) { return value ? "true" : "false"; }
std::string shown(int value) { return fmt::format("{}", value); }

void TomlTable::write_note(std::string_view key, std::string_view expected,
                           std::string_view fallback) const {
  std::string name = path(key);
  // The first of several tables represents all.
  for (std::size_t at = name.find('['); at != std::string::npos; at = name.find('[', at + 1))
    name.erase(at + 1, name.find(']', at) - at - 1);
  const auto same = [&](const AskedKey& other) { return other.path == name; };
  const auto known = std::ranges::find_if(*log_, same);
  if (known == log_->end())
    log_->push_back({std::move(name), std::string(expected), std::string(fallback)});
  else if (known->expected.empty())
    known->expected = expected;
}

TomlTable TomlTable::required_table(std::string_view key) {
  note(key, "a table", "required");
  const toml::node* found = node(key);
  if (found == nullptr) fail(key, "nothing", "a table");
  return child(key, *found);
}

TomlTable TomlTable::optional_table(std::string_view key) {
  static const toml::table empty;
  note(key, "a table", "");
  const toml::node* found = node(key);
  return child(key, found == nullptr ? empty : *found);
}

void TomlTable::require_either(std::string_view one, std::string_view other) {
  const std::string expected = fmt::format("either {} or {}", one, other);
  if (log_ != nullptr) {
    note(one, "", fmt::format("this or {}", other));
    note(other, "", fmt::format("this or {}", one));
  }
  if (has(one) && has(other)) fail(other, "both", expected);
  if (!has(one) && !has(other)) fail(one, "nothing", expected);
}

void TomlTable::finish() const {
  for (const auto& [key, value] : *table_)
    if (std::ranges::find(asked_, key.str()) == asked_.end())
      fail(key.str(), "an unknown key", fmt::format("one of {}", fmt::join(asked_, ", ")));
}

void TomlTable::fail(std::string_view key, std::string_view found,
                     std::string_view expected) const {
  std::string perhaps;
  for (const auto& [other, value] : *table_) {
    const bool asked = std::ranges::find(asked_, other.str()) != asked_.end();
    if (!has(key) && !asked && resembles(key, other.str()))
      perhaps = fmt::format(" ({} in line {}?)", other.str(), value.source().begin.line);
  }
  std::string text = fmt::format("{}: {}: found {}, expected {}{}", where(key), path(key), found,
                                 expected, perhaps);
  std::ranges::replace(text, '\0', ' ');  // it would end the text of the file
  throw Error(GRAINLAW_BAD_MATERIAL, text);
}

const toml::node* TomlTable::node(std::string_view key) {
  note(key, "", "");
  if (std::ranges::find(asked_, key) == asked_.end()) asked_.emplace_back(key);
  return table_->get(key);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  note(key, "tables", "");
  const toml::node* found = node(key);
  std::vector<TomlTable> result;
  if (found == nullptr) return result;
  if (!found->is_array_of_tables())
    fail(key, describe(*found), fmt::format("tables, each under [[{}]]", key));
  for (const toml::node& item : *found->as_array())
    result.push_back(child(fmt::format("{}[{}]", key, result.size() + 1), item));
  return result;
}

TomlTable TomlTable::child(std::string_view key, const toml::node& node) const {
  if (!node.is_table()) fail(key, describe(node), "a table");
  TomlTable table(*node.as_table(), file_, "", log_);
  table.prefix_ = path(key) + '.';
  return table;
}

std::string TomlTable::path(std::string_view key) const { return prefix_ + std::string(key); }

std::string TomlTable::where(std::string_view key) const {
  auto line = table_->source().begin.line;
  for (const auto& [name, value] : *table_)
    if (name.str() == key) line = name.source().begin.line;
  // A table merged from several places has no line of its own.
  if (line == 0 && !table_->empty()) return file_;
  return fmt::format("{}:{}", file_, std::max(line, toml::source_index{1}));
}

std::string TomlTable::place() const {
  return fmt::format("{}: {}", where(""),
                     prefix_.substr(0, prefix_.size() - (prefix_.empty() ? 0 : 1)));
}

std::string TomlTable::describe(const toml::node& node) {
  constexpr std::size_t longest = 60;
  if (node.is_table()) return "a table";
  if (node.is_array_of_tables()) return "an array of tables";
  if (node.is_floating_point()) return fmt::format("{:#}", node.value_or(NAN));
  std::string found;
  if (const toml::array* array = node.as_array()) {
    // toml++ would break lists of small numbers into lines.
    for (auto item = array->begin(); item != array->end() && found.size() <= longest; ++item)
      found += (found.empty() ? "[ " : ", ") + describe(*item);
    found += found.empty() ? "[]" : " ]";
  } else {
    std::ostringstream out;
    out.exceptions(std::ios::badbit);  // set when memory is short
    node.visit([&](const auto& value) { out << value; });
    found = out.str();
  }
  std::ranges::replace(found, '\n', ' ');
  if (found.size() > longest) found = found.substr(0, longest) + "...";
  return found;
}

}  // namespace grainlaw::core

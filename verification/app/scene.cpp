#include "app/scene.hpp"

#include "app/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace verification {
namespace {

// What is written in the file, shortened.
std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array_of_tables()) return "an array of tables";
  constexpr std::size_t longest = 60;
  std::string text;
  if (const toml::array* array = node.as_array()) {
    // toml++ itself breaks lists of small numbers into lines.
    for (auto item = array->begin(); item != array->end() && text.size() <= longest; ++item)
      text += (text.empty() ? "[ " : ", ") + shown(*item);
    text += text.empty() ? "[]" : " ]";
  } else {
    std::ostringstream stream;
    node.visit([&](const auto& value) { stream << value; });
    text = stream.str();
  }
  if (node.is_string()) text = '"' + node.value_or(std::string()) + '"';
  return text.size() > longest ? text.substr(0, longest - 3) + "..." : text;
}

// Whether one may be a slip of the pen for the other: they differ by two letters in one place.
bool resembles(std::string_view a, std::string_view b) {
  constexpr std::size_t slip = 2, in_common = 3;
  if (a.size() > b.size()) std::swap(a, b);
  std::size_t same = 0;
  while (same < a.size() && a[same] == b[same]) ++same;
  std::size_t end = 0;
  while (same + end < a.size() && a[a.size() - 1 - end] == b[b.size() - 1 - end]) ++end;
  return same + end >= in_common && b.size() - same - end <= slip;
}

bool inside(double value, const Range& range) {
  return std::isfinite(value) && value >= range.low && value <= range.high &&
         !(range.open_low && value == range.low);
}

}  // namespace

SceneTable::SceneTable(const toml::table& table, std::filesystem::path file, std::string name)
    : table_(&table), file_(std::move(file)), name_(std::move(name)) {}

const toml::node* SceneTable::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return table_->get(key);
}

const toml::node* SceneTable::node(std::string_view key) { return find(key); }

void SceneTable::fail(std::string_view key, std::string_view found,
                      std::string_view expected) const {
  const toml::node* node = table_->get(key);
  const auto line = (node != nullptr ? node->source() : table_->source()).begin.line;
  std::string perhaps;
  for (const auto& [other, value] : *table_) {
    const bool known = std::find(known_.begin(), known_.end(), other.str()) != known_.end();
    if (node == nullptr && !known && resembles(key, other.str()))
      perhaps = fmt::format(" ({} in line {}?)", other.str(), value.source().begin.line);
  }
  // What was merged from several places has no line of its own.
  throw InputError(fmt::format("{}{}: {}{}{}: found {}, expected {}{}", file_.string(),
                               line > 0 ? fmt::format(":{}", line) : "", name_,
                               name_.empty() ? "" : ".", key, found, expected, perhaps));
}

std::string SceneTable::place() const {
  return fmt::format("{}:{}: {}", file_.string(), table_->source().begin.line, name_);
}

double SceneTable::number(std::string_view key, const Range& range) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "nothing", range.text);
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !inside(*value, range)) fail(key, shown(*node), range.text);
  return *value;
}

double SceneTable::number_or(std::string_view key, double fallback, const Range& range) {
  return find(key) == nullptr ? fallback : number(key, range);
}

int SceneTable::integer(std::string_view key, int low) {
  const toml::node* node = find(key);
  const std::string expected = fmt::format("an integer >= {}", low);
  if (node == nullptr) fail(key, "nothing", expected);
  const auto value = node->is_integer() ? node->value<int>() : std::nullopt;
  if (!value || *value < low) fail(key, shown(*node), expected);
  return *value;
}

int SceneTable::integer_or(std::string_view key, int fallback, int low) {
  return find(key) == nullptr ? fallback : integer(key, low);
}

bool SceneTable::flag_or(std::string_view key, bool fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) fail(key, shown(*node), "true or false");
  return *node->value<bool>();
}

std::string SceneTable::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "nothing", "a text in quotes");
  if (!node->is_string()) fail(key, shown(*node), "a text in quotes");
  return *node->value<std::string>();
}

std::string SceneTable::text_or(std::string_view key, std::string_view fallback) {
  return find(key) == nullptr ? std::string(fallback) : text(key);
}

std::string SceneTable::file_name(std::string_view key) {
  const std::string name = text(key);
  if (!is_file_name(name)) fail(key, '"' + name + '"', file_name_rule);
  return name;
}

std::string SceneTable::file_name_or(std::string_view key, std::string_view fallback) {
  if (find(key) != nullptr) return file_name(key);
  if (!is_file_name(fallback))
    fail(key, fmt::format("nothing, and the file is called \"{}\"", fallback), file_name_rule);
  return std::string(fallback);
}

std::string SceneTable::choice_or(std::string_view key, std::string_view fallback,
                                  const std::vector<std::string_view>& choices) {
  const std::string value = text_or(key, fallback);
  if (std::find(choices.begin(), choices.end(), value) == choices.end())
    fail(key, '"' + value + '"', fmt::format("one of {}", fmt::join(choices, ", ")));
  return value;
}

std::vector<double> SceneTable::numbers(std::string_view key, std::size_t count,
                                        const Range& range) {
  const toml::node* node = find(key);
  const std::string expected = fmt::format("{} numbers, each {}", count, range.text);
  if (node == nullptr) fail(key, "nothing", expected);
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) fail(key, shown(*node), expected);
  std::vector<double> values;
  for (const toml::node& item : *array) {
    const auto value = item.is_number() ? item.value<double>() : std::nullopt;
    if (!value || !inside(*value, range)) fail(key, shown(*node), expected);
    values.push_back(*value);
  }
  return values;
}

SceneTable SceneTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "nothing", "a table");
  if (!node->is_table()) fail(key, shown(*node), "a table");
  return {*node->as_table(), file_,
          name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key)};
}

std::vector<SceneTable> SceneTable::tables(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (!node->is_array_of_tables())
    fail(key, shown(*node), fmt::format("tables, each under [[{}]]", key));
  std::vector<SceneTable> result;
  for (const toml::node& item : *node->as_array())
    result.emplace_back(
        *item.as_table(), file_,
        fmt::format("{}{}{}[{}]", name_, name_.empty() ? "" : ".", key, result.size() + 1));
  return result;
}

void SceneTable::close() const {
  for (const auto& [key, node] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    std::vector<std::string> expected = known_;
    std::sort(expected.begin(), expected.end());
    fail(key.str(), "an unknown key", fmt::format("one of {}", fmt::join(expected, ", ")));
  }
}

SceneFile::SceneFile(const std::filesystem::path& path_) : path(path_) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: there is no such file", path.string()));
  try {
    content = toml::parse_file(path.string());
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: {}", path.string(), error.source().begin.line, error.description()));
  }
}

}  // namespace verification

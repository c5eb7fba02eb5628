#include "app/scene.hpp"

#include "app/text.hpp"
#include "io/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace verification {
namespace {

using grainlaw::core::Expectation;

bool inside(double value, const Range& range) {
  return std::isfinite(value) && value >= range.low && value <= range.high &&
         !(range.open_low && value == range.low);
}

Expectation<double> number_in(const Range& range) {
  return {std::string(range.text), [range](const toml::node& node) {
            const auto value = node.is_number() ? node.value<double>() : std::nullopt;
            return value && inside(*value, range) ? value : std::nullopt;
          }};
}

Expectation<int> integer_between(int low, int high) {
  const bool bounded = high < std::numeric_limits<int>::max();
  return {bounded ? fmt::format("an integer from {} to {}", low, high)
                  : fmt::format("an integer >= {}", low),
          [low, high](const toml::node& node) {
            const auto value = node.is_integer() ? node.value<int>() : std::nullopt;
            return value && *value >= low && *value <= high ? value : std::nullopt;
          }};
}

Expectation<std::string> any_text() {
  return {"a text in quotes",
          [](const toml::node& node) { return node.value_exact<std::string>(); }};
}

Expectation<std::vector<double>> numbers_in(std::size_t count, const Range& range) {
  using Numbers = std::vector<double>;
  return {fmt::format("{} numbers, each {}", count, range.text),
          [count, number = number_in(range)](const toml::node& node) -> std::optional<Numbers> {
            const toml::array* array = node.as_array();
            if (array == nullptr || array->size() != count) return std::nullopt;
            Numbers values;
            for (const toml::node& item : *array) {
              const auto value = number.read(item);
              if (!value) return std::nullopt;
              values.push_back(*value);
            }
            return values;
          }};
}

}  // namespace

SceneTable::SceneTable(const toml::table& table, std::filesystem::path file,
                       const std::string& name, grainlaw::core::KeyLog* log)
    : table_(table, file.string(), name, log), file_(std::move(file)) {}

SceneTable::SceneTable(grainlaw::core::TomlTable table, std::filesystem::path file)
    : table_(std::move(table)), file_(std::move(file)) {}

void SceneTable::fail(std::string_view key, std::string_view found,
                      std::string_view expected) const {
  as<InputError>([&] { table_.fail(key, found, expected); });
  throw std::logic_error("a table's failure did not fail");
}

template <class T>
T SceneTable::required(std::string_view key, const Expectation<T>& expectation) {
  return as<InputError>([&] { return table_.required(key, expectation); });
}

template <class T, class Shown>
T SceneTable::optional(std::string_view key, const Expectation<T>& expectation,
                       const Shown& fallback) {
  table_.note(key, expectation.text, grainlaw::core::shown(fallback));
  return has(key) ? required(key, expectation) : T(fallback);
}

double SceneTable::number(std::string_view key, const Range& range) {
  return required(key, number_in(range));
}

double SceneTable::number_or(std::string_view key, double fallback, const Range& range) {
  return optional(key, number_in(range), fallback);
}

int SceneTable::integer(std::string_view key, int low) {
  return required(key, integer_between(low, std::numeric_limits<int>::max()));
}

int SceneTable::integer_or(std::string_view key, int fallback, int low, int high) {
  return optional(key, integer_between(low, high), fallback);
}

bool SceneTable::flag_or(std::string_view key, bool fallback) {
  return optional(key, grainlaw::core::boolean(), fallback);
}

std::string SceneTable::text(std::string_view key) { return required(key, any_text()); }

std::string SceneTable::text_or(std::string_view key, std::string_view fallback) {
  return optional(key, any_text(), fallback);
}

std::string SceneTable::file_name(std::string_view key) {
  const std::string name = text(key);
  if (!is_file_name(name)) fail(key, '"' + name + '"', file_name_rule);
  return name;
}

std::string SceneTable::file_name_or(std::string_view key, std::string_view fallback) {
  table_.note(key, "a text in quotes", fallback);
  if (has(key)) return file_name(key);
  if (!is_file_name(fallback))
    fail(key, fmt::format("nothing, and the file is called \"{}\"", fallback), file_name_rule);
  return std::string(fallback);
}

std::string SceneTable::choice_or(std::string_view key, std::string_view fallback,
                                  const std::vector<std::string_view>& choices) {
  const std::string expected = fmt::format("one of {}", fmt::join(choices, ", "));
  table_.note(key, expected, '"' + std::string(fallback) + '"');
  const std::string value = text_or(key, fallback);
  if (std::find(choices.begin(), choices.end(), value) == choices.end())
    fail(key, '"' + value + '"', expected);
  return value;
}

std::vector<double> SceneTable::numbers(std::string_view key, std::size_t count,
                                        const Range& range) {
  return required(key, numbers_in(count, range));
}

SceneTable SceneTable::table(std::string_view key) {
  return {as<InputError>([&] { return table_.required_table(key); }), file_};
}

std::vector<SceneTable> SceneTable::tables(std::string_view key) {
  std::vector<SceneTable> result;
  for (grainlaw::core::TomlTable& table : as<InputError>([&] { return table_.tables(key); }))
    result.push_back(SceneTable(std::move(table), file_));
  return result;
}

void SceneTable::close() const {
  as<InputError>([&] { table_.finish(); });
}

SceneFile::SceneFile(std::filesystem::path path_, toml::table content_)
    : path(std::move(path_)), content(std::move(content_)) {}

SceneFile::SceneFile(const std::filesystem::path& path_) : path(path_) {
  content = as<InputError>([&] {
    return grainlaw::core::parse_toml(grainlaw::core::read_text(path.string()), path.string());
  });
}

}  // namespace verification

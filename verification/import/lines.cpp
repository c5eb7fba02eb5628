#include "import/source_table.hpp"

#include <charconv>
#include <cmath>

namespace verification {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.back() == text.front())
    text = trimmed(text.substr(1, text.size() - 2));
  return text;
}

// Where a unit in brackets begins; the number of a component of LAMMPS, c_pair[1], is no unit.
std::size_t unit_begin(std::string_view name) {
  const auto bracket = name.find_first_of("[(");
  const bool numbered = bracket != std::string_view::npos && bracket + 1 < name.size() &&
                        name[bracket + 1] >= '0' && name[bracket + 1] <= '9';
  return bracket == 0 || numbered ? std::string_view::npos : bracket;
}

}  // namespace

bool Lines::next() {
  if (rest_.empty()) return false;
  const auto end = rest_.find('\n');
  line_ = trimmed(rest_.substr(0, end));
  rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
  ++number_;
  return true;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> result;
  for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    result.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(blanks, end);
  }
  return result;
}

std::vector<std::string_view> fields(std::string_view line, const std::string& separator) {
  if (separator == " ") {
    std::vector<std::string_view> result = words(line);
    for (std::string_view& field : result) field = unquoted(field);
    return result;
  }
  std::vector<std::string_view> result;
  for (;;) {
    const auto end = line.find(separator);
    result.push_back(unquoted(line.substr(0, end)));
    if (end == std::string_view::npos) return result;
    line.remove_prefix(end + separator.size());
  }
}

std::optional<double> number_in(std::string_view field) {
  if (field.size() > 1 && field.front() == '+' && field[1] != '-') field.remove_prefix(1);
  double value = 0;
  const char* end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (field.empty() || error != std::errc{} || stop != end || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::string plain_name(std::string_view field) {
  field = unquoted(field);
  std::string name(trimmed(field.substr(0, unit_begin(field))));
  for (char& letter : name)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  return name;
}

std::string unit_of_name(std::string_view field) {
  field = unquoted(field);
  const auto begin = unit_begin(field);
  if (begin == std::string_view::npos) return {};
  const std::string_view unit = field.substr(begin + 1);
  return std::string(trimmed(unit.substr(0, unit.find_first_of("])"))));
}

std::vector<std::string_view> names_in(const std::vector<std::string_view>& words) {
  std::vector<std::string_view> names;
  for (const std::string_view word : words) {
    const bool begins = word.starts_with('[') || word.starts_with('(');
    const bool open = !names.empty() && unit_begin(names.back()) != std::string_view::npos &&
                      names.back().find_first_of("])") == std::string_view::npos;
    if (!names.empty() && (begins || open))
      names.back() = {names.back().data(),
                      static_cast<std::size_t>(word.data() + word.size() - names.back().data())};
    else
      names.push_back(word);
  }
  return names;
}

}  // namespace verification

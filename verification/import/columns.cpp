#include "import/source_table.hpp"

#include "app/library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace verification {

ColumnChoice read_choice(const std::string& option, const std::string& text) {
  ColumnChoice choice;
  if (text.empty()) return choice;
  for (const std::string_view part : fields(text, ",")) {
    const auto equals = part.find('=');
    if (equals == 0 || equals == std::string_view::npos || equals + 1 == part.size())
      throw InputError(fmt::format(
          "{}: found '{}', expected NAME=COLUMN, by its name or place: x=1,y=2,r=radius", option,
          part));
    choice[plain_name(part.substr(0, equals))] = plain_name(part.substr(equals + 1));
  }
  return choice;
}

Columns::Columns(const SourceTable& table, ColumnChoice choice)
    : table_(table), choice_(std::move(choice)) {}

double Columns::unit(const std::string& name, std::size_t index, Quantity quantity) const {
  const std::vector<std::string>& units = table_.column_units;
  if (quantity == Quantity::number || index >= units.size() || units[index].empty())
    return table_.unit(quantity);
  const auto fail = [&](const std::string& expected) {
    table_.fail(table_.lines.front(),
                fmt::format("column {} ({}): found the unit [{}], expected {}", index + 1, name,
                            units[index], expected));
  };
  const auto unit = in_si(units[index], quantity);
  if (!unit) fail(expected_unit(quantity));
  if ((quantity == Quantity::length && table_.units.length > 0 && table_.units.length != *unit) ||
      (quantity == Quantity::force && table_.units.force > 0 && table_.units.force != *unit))
    fail("that of --length-unit and --force-unit, or none there");
  return *unit;
}

void Columns::find(const std::string& name, const std::vector<std::string>& others,
                   Quantity quantity, std::size_t index) {
  const std::vector<std::string>& names = table_.names;
  const std::size_t width = table_.rows.front().size();
  const auto take = [&](std::size_t k) {
    found_[name] = {k, unit(name, k, quantity)};
    order_.push_back(name);
  };
  wanted_.push_back(name);
  if (const auto chosen = choice_.find(name); chosen != choice_.end()) {
    const auto found = std::find(names.begin(), names.end(), chosen->second);
    if (found != names.end()) return take(static_cast<std::size_t>(found - names.begin()));
    const auto number = number_in(chosen->second);
    if (number && *number >= 1 && *number <= static_cast<double>(width) &&
        *number == std::floor(*number))
      return take(static_cast<std::size_t>(*number) - 1);
    table_.fail(table_.lines.front(),
                fmt::format("{}: found no column '{}', expected {}", name, chosen->second,
                            names.empty() ? fmt::format("a place from 1 to {}", width)
                                          : fmt::format("one of {}", fmt::join(names, ", "))));
  }
  for (const std::string& other : others)
    if (const auto found = std::find(names.begin(), names.end(), other); found != names.end())
      return take(static_cast<std::size_t>(found - names.begin()));
  if (names.empty() && index > 0 && index <= width) take(index - 1);
}

void Columns::require(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    if (has(name)) continue;
    const std::size_t width = table_.rows.front().size();
    table_.fail(
        table_.lines.front(),
        fmt::format("found no column '{}' among {}, expected one; the options --columns and "
                    "--contact-columns say where it stands, by name or place: {}={}",
                    name,
                    table_.names.empty() ? fmt::format("the {} without names", width)
                                         : fmt::format("{}", fmt::join(table_.names, ", ")),
                    name, table_.names.empty() ? std::to_string(width) : table_.names.back()));
  }
}

void Columns::close(const std::string& option) const {
  for (const auto& [name, column] : choice_)
    if (std::find(wanted_.begin(), wanted_.end(), name) == wanted_.end())
      throw InputError(fmt::format("{}: found '{}', expected one of {}", option, name,
                                   fmt::join(wanted_, ", ")));
}

std::string_view Columns::field(std::size_t row, const std::string& name) const {
  return table_.rows[row][found_.at(name).index];
}

void Columns::complain(std::size_t row, const std::string& name, std::string_view expected) const {
  table_.fail(table_.lines[row],
              fmt::format("column {} ({}): found '{}', expected {}", found_.at(name).index + 1,
                          name, field(row, name), expected));
}

double Columns::real(std::size_t row, const std::string& name) const {
  const auto value = number_in(field(row, name));
  if (!value) complain(row, name, "a finite number");
  return *value * found_.at(name).unit;
}

double Columns::positive(std::size_t row, const std::string& name) const {
  const auto value = number_in(field(row, name));
  if (!value || !(*value > 0)) complain(row, name, "a number > 0");
  return *value * found_.at(name).unit;
}

long Columns::integer(std::size_t row, const std::string& name) const {
  constexpr double most = 9e15;
  const auto value = number_in(field(row, name));
  if (!value || *value != std::floor(*value) || std::abs(*value) > most)
    complain(row, name, "an integer");
  return static_cast<long>(*value);
}

std::string Columns::text() const {
  std::vector<std::string> names, numbers;
  for (const std::string& name : order_) {
    const std::size_t index = found_.at(name).index;
    const bool has_unit = index < table_.column_units.size() && !table_.column_units[index].empty();
    names.push_back(has_unit ? fmt::format("{} [{}]", name, table_.column_units[index]) : name);
    numbers.push_back(std::to_string(index + 1));
  }
  return fmt::format("{} (columns {})", fmt::join(names, ", "), fmt::join(numbers, ", "));
}

}  // namespace verification

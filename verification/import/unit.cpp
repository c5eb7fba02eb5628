#include "import/unit.hpp"

#include "import/source_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace verification {
namespace {

struct Unit {
  double in_si = 1;
  std::array<int, 3> powers{};  // of metre, kilogram, second
};

struct Named {
  std::string_view name;
  Unit unit;
};

constexpr std::array<Named, 9> bases{{{"m", {1, {1, 0, 0}}},
                                      {"g", {1e-3, {0, 1, 0}}},
                                      {"t", {1e3, {0, 1, 0}}},
                                      {"s", {1, {0, 0, 1}}},
                                      {"N", {1, {1, 1, -2}}},
                                      {"dyn", {1e-5, {1, 1, -2}}},
                                      {"Nm", {1, {2, 1, -2}}},
                                      {"Nmm", {1e-3, {2, 1, -2}}},
                                      {"Pa", {1, {-1, 1, -2}}}}};

constexpr std::array<std::pair<std::string_view, double>, 11> prefixes{{{"", 1},
                                                                        {"n", 1e-9},
                                                                        {"u", 1e-6},
                                                                        {"\u00b5", 1e-6},
                                                                        {"\u03bc", 1e-6},
                                                                        {"m", 1e-3},
                                                                        {"c", 1e-2},
                                                                        {"d", 1e-1},
                                                                        {"k", 1e3},
                                                                        {"M", 1e6},
                                                                        {"G", 1e9}}};

struct Kind {
  std::array<int, 3> powers;
  const char* expected;
};

// By Quantity.
constexpr std::array<Kind, 6> kinds{{{{0, 0, 0}, "no unit"},
                                     {{1, 0, 0}, "a length, as m or mm"},
                                     {{1, 1, -2}, "a force, as N or kN"},
                                     {{2, 1, -2}, "a moment, as N m or N mm"},
                                     {{0, 1, -2}, "a force over a length, as N/m"},
                                     {{-3, 1, 0}, "a density, as kg/m3 or g/cm3"}}};

const Kind& kind_of(Quantity quantity) { return kinds[static_cast<std::size_t>(quantity)]; }

std::optional<Unit> named(std::string_view word) {
  for (const auto& [prefix, times] : prefixes)
    for (const auto& [name, unit] : bases)
      if (word.size() == prefix.size() + name.size() && word.starts_with(prefix) &&
          word.ends_with(name))
        return Unit{times * unit.in_si, unit.powers};
  return std::nullopt;
}

// One factor: "cm3", "m^-3".
std::optional<Unit> factor(std::string_view text) {
  const auto end = std::min(text.find_first_of("^-0123456789"), text.size());
  int power = 1;
  if (std::string_view digits = text.substr(end); !digits.empty()) {
    if (digits.front() == '^') digits.remove_prefix(1);
    const char* last = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), last, power);
    if (error != std::errc{} || stop != last || std::abs(power) > 9) return std::nullopt;
  }
  std::optional<Unit> unit = named(text.substr(0, end));
  if (!unit) return std::nullopt;
  unit->in_si = std::pow(unit->in_si, power);
  for (int& p : unit->powers) p *= power;
  return unit;
}

}  // namespace

std::optional<double> in_si(std::string_view unit, Quantity quantity) {
  Unit product;
  bool over = false;
  while (!unit.empty()) {
    const auto end = std::min(unit.find_first_of(" *./"), unit.size());
    if (const std::string_view word = unit.substr(0, end); !word.empty()) {
      const std::optional<Unit> one = factor(word);
      if (!one) return std::nullopt;
      product.in_si = over ? product.in_si / one->in_si : product.in_si * one->in_si;
      for (std::size_t k = 0; k < 3; ++k)
        product.powers[k] += over ? -one->powers[k] : one->powers[k];
      over = false;
    }
    over = over || (end < unit.size() && unit[end] == '/');
    unit.remove_prefix(std::min(end + 1, unit.size()));
  }
  if (product.powers != kind_of(quantity).powers) return std::nullopt;
  return product.in_si;
}

std::string expected_unit(Quantity quantity) { return kind_of(quantity).expected; }

std::optional<double> FileUnits::of(Quantity quantity) const {
  const auto told = [&](double unit) -> std::optional<double> {
    if (unit > 0) return unit;
    return dimensionless ? std::nullopt : std::optional(1.0);
  };
  const std::optional<double> l = told(length), f = told(force);
  switch (quantity) {
    case Quantity::length:
      return l;
    case Quantity::force:
      return f;
    case Quantity::moment:
      return l && f ? std::optional(*f * *l) : std::nullopt;
    case Quantity::stiffness:
      return l && f ? std::optional(*f / *l) : std::nullopt;
    case Quantity::density:
      return told(density);
    case Quantity::number:
      break;
  }
  return 1;
}

std::optional<FileUnits> units_of_lammps(std::string_view name) {
  FileUnits units;
  if (name == "si")
    units = {1, 1, 1, {}, false};
  else if (name == "cgs")
    units = {1e-2, 1e-5, 1e3, {}, false};
  else if (name == "micro")  // pg um/us2
    units = {1e-6, 1e-9, 1e3, {}, false};
  else if (name == "nano")  // ag nm/ns2
    units = {1e-9, 1e-12, 1e6, {}, false};
  else if (name == "lj")
    units.dimensionless = true;
  else
    return std::nullopt;
  units.name = name;
  return units;
}

}  // namespace verification

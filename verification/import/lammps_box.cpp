#include "import/lammps_box.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification {

double lammps_number(const SourceTable& table, const Lines& lines,
                     const std::vector<std::string_view>& parts, std::size_t k) {
  const auto value = k < parts.size() ? number_in(parts[k]) : std::nullopt;
  if (!value)
    table.fail(lines.number(),
               fmt::format("column {}: found {}, expected a number", k + 1,
                           k < parts.size() ? fmt::format("'{}'", parts[k]) : "nothing"));
  return *value;
}

void LammpsBox::from_bounds() {
  low[0] -= std::min({0.0, xy, xz, xy + xz});
  high[0] -= std::max({0.0, xy, xz, xy + xz});
  low[1] -= std::min(0.0, yz);
  high[1] -= std::max(0.0, yz);
}

void LammpsBox::give(SourceTable& table, std::size_t line) const {
  table.origin = low;
  if (vectors) {
    table.cell.emplace();
    for (std::size_t k = 0; k < 9; ++k) (*table.cell)[k] = (*vectors)[k % 3][k / 3];
    return;
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (!(high[k] > low[k]))
      table.fail(line, fmt::format("found a box from {:g} to {:g} in direction {}, expected an "
                                   "upper bound above the lower one",
                                   low[k], high[k], "xyz"[k]));
  table.cell = Lattice{high[0] - low[0], xy, xz, 0, high[1] - low[1], yz, 0, 0, high[2] - low[2]};
}

void take_lammps_units(SourceTable& table, std::size_t line, std::string_view name) {
  const auto units = units_of_lammps(name);
  if (!units)
    table.fail(line,
               fmt::format("found the units '{}', expected si, cgs, micro, nano or lj", name));
  table.units = *units;
}

}  // namespace verification

// What dumps and data files of LAMMPS share (its manual: Howto_triclinic, units).
#pragma once

#include "import/source_table.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace verification {

// The word at a place of the present line as a number; throws for another.
double lammps_number(const SourceTable& table, const Lines& lines,
                     const std::vector<std::string_view>& parts, std::size_t k);

struct LammpsBox {
  Position low{}, high{};
  double xy = 0, xz = 0, yz = 0;
  std::optional<std::array<Position, 3>> vectors;  // of a general triclinic one; its corner is low

  // From the bounds of the box around a tilted one.
  void from_bounds();
  // Throws at the line for an empty box.
  void give(SourceTable& table, std::size_t line) const;
};

void take_lammps_units(SourceTable& table, std::size_t line, std::string_view name);

}  // namespace verification

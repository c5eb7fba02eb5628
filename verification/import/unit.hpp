// Units of columns and of files, in SI.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace verification {

enum class Quantity { number, length, force, moment, stiffness, density };

// "mm" as a length: 1e-3. Nothing for a unit that is unknown or not of this quantity.
std::optional<double> in_si(std::string_view unit, Quantity quantity);

// For a person: "a length, as m or mm".
std::string expected_unit(Quantity quantity);

// What one unit of a file is in SI; 0 where nobody says, which is SI too unless it is dimensionless.
struct FileUnits {
  double length = 0, force = 0, density = 0;
  std::string name;            // that LAMMPS has for them, "cgs"; or ""
  bool dimensionless = false;  // "lj"

  // Nothing where it has none.
  [[nodiscard]] std::optional<double> of(Quantity quantity) const;
};

// Units that LAMMPS names by one word; nothing where they are no packing's.
std::optional<FileUnits> units_of_lammps(std::string_view name);

}  // namespace verification

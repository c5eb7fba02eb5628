// What soil mechanics plots of a table of a path: compression positive, in kPa.
#pragma once

#include "app/csv.hpp"

#include <vector>

namespace verification {

struct Stresses {
  std::vector<double> axial, lateral, shear, mean;

  // q, axial less lateral: negative in extension.
  [[nodiscard]] std::vector<double> deviatoric() const;
};

// Reads the stresses of records of discs or spheres; shear belongs to the plane of axis 1 and the last.
Stresses stresses_of(const CsvTable& table);

// The cycle of every point, from 1: the second turn of the abscissa ends the first. A turn counts where
// the abscissa comes back by a twentieth of its range. Empty where there are fewer than two.
std::vector<int> cycles_of(const std::vector<double>& abscissa);

}  // namespace verification

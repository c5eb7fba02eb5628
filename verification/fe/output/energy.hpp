// Energies of a dynamic run as a table.
#pragma once

#include "fe/solver/solver.hpp"

#include <string>
#include <vector>

namespace verification {

std::vector<std::string> energy_columns(int dimension);
std::vector<double> energy_values(const LoadStep& step);  // for a step with energies

}  // namespace verification

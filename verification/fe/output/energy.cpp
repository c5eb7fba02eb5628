#include "fe/output/energy.hpp"

namespace verification {

std::vector<std::string> energy_columns(int dimension) {
  std::vector<std::string> columns{"step[-]", "time[s]"};
  for (const char* name : {"kinetic", "internal", "external", "damped", "balance"})
    columns.push_back(std::string(name) + (dimension == 2 ? "[J/m]" : "[J]"));
  return columns;
}

std::vector<double> energy_values(const LoadStep& step) {
  const Energies& energies = step.energies.value();
  return {static_cast<double>(step.record.step),
          step.time,
          energies.kinetic,
          energies.internal,
          energies.external,
          energies.damped,
          energies.balance()};
}

}  // namespace verification

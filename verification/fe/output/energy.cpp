#include "fe/output/energy.hpp"

namespace verification {

std::vector<std::string> energy_columns() {
  return {"step[-]",       "time[s]",     "kinetic[J/m]", "internal[J/m]",
          "external[J/m]", "damped[J/m]", "balance[J/m]"};
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

#include "fe/output/energy.hpp"

#include <string>
#include <vector>

namespace verification {

void EnergyHistory::add(const LoadStep& step) {
  if (!step.energies) return;
  if (!csv_)
    csv_.emplace(stem_.string() + "_energy.csv",
                 std::vector<std::string>{"time[s]", "kinetic[J/m]", "internal[J/m]",
                                          "external[J/m]", "damped[J/m]", "balance[J/m]"});
  const Energies& energies = *step.energies;
  csv_->row({step.time, energies.kinetic, energies.internal, energies.external, energies.damped,
             energies.balance()});
}

}  // namespace verification

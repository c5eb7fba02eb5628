#include "app/stresses.hpp"

#include <algorithm>
#include <cmath>

namespace verification {

std::vector<double> Stresses::deviatoric() const {
  std::vector<double> q;
  for (std::size_t k = 0; k < axial.size(); ++k) q.push_back(axial[k] - lateral[k]);
  return q;
}

Stresses stresses_of(const CsvTable& table) {
  constexpr double kilopascal = 1e-3;
  const bool spheres =
      std::find(table.names.begin(), table.names.end(), "sigma33") != table.names.end();
  const auto& axial = table[spheres ? "sigma33" : "sigma22"];
  const auto& shear = table[spheres ? "sigma13" : "sigma12"];
  const auto& first = table["sigma11"];
  const auto& second = table["sigma22"];
  Stresses s;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    const double lateral = spheres ? 0.5 * (first[k] + second[k]) : first[k];
    s.axial.push_back(-kilopascal * axial[k]);
    s.lateral.push_back(-kilopascal * lateral);
    s.shear.push_back(kilopascal * shear[k]);
    s.mean.push_back((s.axial.back() + (spheres ? 2 : 1) * s.lateral.back()) / (spheres ? 3 : 2));
  }
  return s;
}

std::vector<int> cycles_of(const std::vector<double>& abscissa) {
  if (abscissa.empty()) return {};
  const auto [low, high] = std::minmax_element(abscissa.begin(), abscissa.end());
  const double least = 0.05 * (*high - *low);
  std::vector<int> cycles;
  int reversals = 0, direction = 0;
  double extreme = abscissa.front();  // since the last turn
  for (const double x : abscissa) {
    const double back = x - extreme;
    if (direction == 0 ? std::abs(back) > least : -direction * back > least) {
      if (direction != 0) ++reversals;
      direction = back > 0 ? 1 : -1;
      extreme = x;
    } else if (direction * back > 0) {
      extreme = x;
    }
    cycles.push_back(1 + reversals / 2);
  }
  // What comes after the last turn of a cycle belongs to it.
  const int last = (reversals + 1) / 2;
  for (int& cycle : cycles) cycle = std::min(cycle, last);
  return last < 2 ? std::vector<int>{} : cycles;
}

}  // namespace verification

#include "point/price_of_drag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace verification {
namespace {

// Frobenius norms of the deviator of the Cauchy stress [Pa].
std::vector<double> deviators(const CsvTable& table) {
  const auto& names = table.names;
  const int dimension = std::find(names.begin(), names.end(), "sigma33") == names.end() ? 2 : 3;
  std::vector<double> result(table.rows());
  for (std::size_t row = 0; row < result.size(); ++row) {
    double mean = 0, squares = 0;
    for (int i = 1; i <= dimension; ++i)
      mean += table[fmt::format("sigma{0}{0}", i)][row] / dimension;
    for (int i = 1; i <= dimension; ++i) {
      for (int j = 1; j <= dimension; ++j) {
        const double part = table[fmt::format("sigma{}{}", i, j)][row] - (i == j ? mean : 0);
        squares += part * part;
      }
    }
    result[row] = std::sqrt(squares);
  }
  return result;
}

}  // namespace

PointScene in_equilibrium(const PointScene& scene) {
  PointScene result = scene;
  result.name += "_equilibrium";
  result.material = unfold(scene.material);
  toml::table& solver = *result.material.changes["solver"].as_table();
  for (const char* key : {"viscous_number", "viscous_rate", "viscous_steps"}) solver.erase(key);
  return result;
}

std::string price_of_drag(const CsvTable& with_drag, const CsvTable& equilibrium) {
  constexpr double percent = 100;
  const auto dragged = deviators(with_drag), balanced = deviators(equilibrium);
  const std::size_t rows = std::min(dragged.size(), balanced.size());
  double difference = 0, sum = 0, largest = 0, most = 0;
  std::size_t worst = 0;
  for (std::size_t row = 1; row < rows; ++row) {
    difference += dragged[row] - balanced[row];
    sum += balanced[row];
    largest = std::max(largest, balanced[row]);
    const double off = std::abs(dragged[row] - balanced[row]);
    if (off <= most) continue;
    most = off;
    worst = row;
  }
  if (!(sum > 0)) return "no step with a stress deviator to compare with equilibrium";
  const std::size_t last = rows - 1;
  const auto& volumes = with_drag["volumetric_strain"];
  return fmt::format(
      "against equilibrium over {} steps: stress deviator {:+.2f} % in the mean, {:.2f} % of its "
      "largest value at most (step {:.0f}); volumetric strain {:.3f} % at the end, {:.3f} % in "
      "equilibrium",
      last, percent * difference / sum, percent * most / largest, with_drag["step"][worst],
      percent * volumes[last], percent * equilibrium["volumetric_strain"][last]);
}

}  // namespace verification

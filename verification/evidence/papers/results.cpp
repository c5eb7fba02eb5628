#include "evidence/papers/results.hpp"

#include "app/scene.hpp"

#include <algorithm>
#include <cmath>

namespace verification {

PaperUnits read_units(const std::filesystem::path& material) {
  const SceneFile file(material);
  PaperUnits units;
  const auto number = [&](toml::node_view<const toml::node> node, const char* key) {
    const auto value = node.value<double>();
    if (!value) throw InputError(material.string() + ": " + key + " is missing");
    return *value;
  };
  const toml::table& content = file.content;
  units.thickness = number(content["thickness"], "thickness");
  units.stiffness = number(content["contact"]["kn"], "contact.kn");
  const auto packing = content["packing"];
  if (packing["radii"].is_array())
    units.mean_radius = 0.5 * (number(packing["radii"][0], "packing.radii") +
                               number(packing["radii"][1], "packing.radii"));
  else
    units.mean_radius = number(packing["radius"], "packing.radius");
  return units;
}

std::vector<double> PaperRun::column(const char* wanted, double factor) const {
  std::vector<double> values = history[wanted];
  for (double& value : values) value *= factor;
  return values;
}

std::optional<PaperRun> load_run(const std::filesystem::path& directory, const std::string& name) {
  const std::filesystem::path path = directory / (name + ".csv");
  if (!std::filesystem::is_regular_file(path)) return std::nullopt;
  PaperRun run{name, read_csv(path), std::nullopt};
  const std::filesystem::path particles = directory / (name + "_particles.csv");
  if (std::filesystem::is_regular_file(particles)) run.particles = read_csv(particles);
  return run;
}

CaseEnds::CaseEnds(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return;
  table = read_csv(path);
  name = read_csv_names(path);
}

std::optional<std::size_t> CaseEnds::find(const std::string& wanted) const {
  const auto found = std::find(name.begin(), name.end(), wanted);
  if (found == name.end()) return std::nullopt;
  return static_cast<std::size_t>(found - name.begin());
}

std::vector<double> stress_norm(const PaperRun& run, const PaperUnits& units) {
  std::vector<double> norm(run.steps(), 0.0);
  for (const char* component : {"sigma11", "sigma12", "sigma21", "sigma22"}) {
    const std::vector<double>& sigma = run.history[component];
    for (std::size_t k = 0; k < norm.size(); ++k) norm[k] += sigma[k] * sigma[k];
  }
  for (double& value : norm) value = std::sqrt(value) * units.stress();
  return norm;
}

double integrated_norm(const PaperRun& run, const PaperUnits& units, double until) {
  const std::vector<double>& shear = run.history["F12"];
  const std::vector<double> norm = stress_norm(run, units);
  double sum = 0;
  for (std::size_t k = 1; k < norm.size() && shear[k] < until + 1e-9; ++k)
    sum +=
        0.5 * (norm[k] * norm[k] + norm[k - 1] * norm[k - 1]) * std::abs(shear[k] - shear[k - 1]);
  return std::sqrt(sum);
}

double largest_rise(const std::vector<double>& values) {
  double rise = 0;
  for (std::size_t k = 1; k < values.size(); ++k) rise = std::max(rise, values[k] / values[k - 1]);
  return rise;
}

double least_rise(const std::vector<double>& values) {
  double rise = INFINITY;
  for (std::size_t k = 1; k < values.size(); ++k) rise = std::min(rise, values[k] / values[k - 1]);
  return rise;
}

double spread(const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return *largest / *least;
}

Order compare(const PaperRun& stiff, const PaperRun& soft, const PaperUnits& units) {
  constexpr double rounding = 1e-6;
  const std::vector<double> a = stress_norm(stiff, units);
  const std::vector<double> b = stress_norm(soft, units);
  const auto stored = [](const PaperRun& run) -> const std::vector<double>& {
    return run.history["elastic_energy"];
  };
  const auto dissipated = [](const PaperRun& run) -> const std::vector<double>& {
    return run.history["dissipated_energy"];
  };
  const std::size_t count = std::min(a.size(), b.size());
  Order order;
  if (count == 0) return order;
  double sum_a = 0, sum_b = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto no_less = [](double x, double y) { return x >= y * (1 - rounding) ? 1.0 : 0.0; };
    const double energy_a = stored(stiff)[k], energy_b = stored(soft)[k];
    order.share += no_less(a[k], b[k]);
    order.energy_share += no_less(energy_a, energy_b);
    order.spent_share += no_less(energy_a + dissipated(stiff)[k], energy_b + dissipated(soft)[k]);
    sum_a += a[k];
    sum_b += b[k];
  }
  for (double* share : {&order.share, &order.energy_share, &order.spent_share})
    *share /= static_cast<double>(count);
  order.mean_ratio = sum_a / sum_b;
  order.until = soft.history["F12"][count - 1];
  order.steps = static_cast<int>(count);
  return order;
}

}  // namespace verification

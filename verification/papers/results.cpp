#include "papers/results.hpp"

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

std::vector<double> stress_norm(const PaperRun& run, const PaperUnits& units) {
  std::vector<double> norm(run.steps(), 0.0);
  for (const char* component : {"sigma11", "sigma12", "sigma21", "sigma22"}) {
    const std::vector<double>& sigma = run.history[component];
    for (std::size_t k = 0; k < norm.size(); ++k) norm[k] += sigma[k] * sigma[k];
  }
  for (double& value : norm) value = std::sqrt(value) * units.stress();
  return norm;
}

double integrated_norm(const PaperRun& run, const PaperUnits& units) {
  const std::vector<double>& shear = run.history["F12"];
  const std::vector<double> norm = stress_norm(run, units);
  double sum = 0;
  for (std::size_t k = 1; k < norm.size(); ++k)
    sum +=
        0.5 * (norm[k] * norm[k] + norm[k - 1] * norm[k - 1]) * std::abs(shear[k] - shear[k - 1]);
  return std::sqrt(sum);
}

Order compare(const PaperRun& stiff, const PaperRun& soft, const PaperUnits& units) {
  const std::vector<double> a = stress_norm(stiff, units);
  const std::vector<double> b = stress_norm(soft, units);
  const std::size_t count = std::min(a.size(), b.size());
  Order order;
  double sum_a = 0, sum_b = 0;
  for (std::size_t k = 0; k < count; ++k) {
    constexpr double rounding = 1e-6;
    order.share += a[k] >= b[k] * (1 - rounding) ? 1 : 0;
    sum_a += a[k];
    sum_b += b[k];
  }
  if (count == 0) return order;
  order.share /= static_cast<double>(count);
  order.mean_ratio = sum_a / sum_b;
  order.until = soft.history["F12"][count - 1];
  return order;
}

}  // namespace verification

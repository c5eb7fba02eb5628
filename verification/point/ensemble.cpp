#include "point/ensemble.hpp"

#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/history.hpp"
#include "app/record.hpp"
#include "app/written.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace verification {
namespace {

struct Spread {
  std::vector<std::string> names;
  std::vector<int> runs;                             // runs that reached the row
  std::vector<std::vector<double>> mean, deviation;  // per column

  [[nodiscard]] std::size_t column(std::string_view name) const {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }
};

Spread spread_of(const std::vector<CsvTable>& tables) {
  Spread spread{tables.front().names, {}, {}, {}};
  std::size_t rows = 0;
  for (const CsvTable& table : tables) rows = std::max(rows, table.rows());
  spread.mean.assign(spread.names.size(), std::vector<double>(rows));
  spread.deviation = spread.mean;
  for (std::size_t row = 0; row < rows; ++row) {
    int runs = 0;
    for (const CsvTable& table : tables) runs += row < table.rows() ? 1 : 0;
    spread.runs.push_back(runs);
    for (std::size_t c = 0; c < spread.names.size(); ++c) {
      double sum = 0, squares = 0;
      for (const CsvTable& table : tables)
        if (row < table.rows()) sum += table.columns[c][row];
      const double mean = sum / runs;
      for (const CsvTable& table : tables)
        if (row < table.rows()) squares += std::pow(table.columns[c][row] - mean, 2);
      spread.mean[c][row] = mean;
      spread.deviation[c][row] = runs > 1 ? std::sqrt(squares / (runs - 1)) : 0;
    }
  }
  return spread;
}

void write_table(const Spread& spread, bool spheres, const std::filesystem::path& path) {
  const bool drag = spread.column("unbalanced") < spread.names.size();
  const std::vector<std::string> units =
      spheres ? record_columns<3>(drag) : record_columns<2>(drag);
  std::vector<std::string> columns{"runs[-]"};
  for (const std::string& name : units) columns.insert(columns.end(), {name, "sd_" + name});
  std::vector<std::vector<double>> rows;
  for (std::size_t row = 0; row < spread.runs.size(); ++row) {
    rows.push_back({static_cast<double>(spread.runs[row])});
    for (std::size_t c = 0; c < spread.names.size(); ++c)
      rows.back().insert(rows.back().end(), {spread.mean[c][row], spread.deviation[c][row]});
  }
  write_csv(path, columns, rows);
}

Figure figure_of(const Spread& spread, bool spheres, const std::string& abscissa,
                 const std::string& title) {
  const bool shear = abscissa != axial_abscissa;
  std::vector<double> x = spread.mean[spread.column(abscissa)];
  for (double& value : x) value *= shear ? 1 : 100;
  const auto curve = [&](const char* name, const char* column, double unit, const char* colour) {
    const std::size_t c = spread.column(column);
    Curve result{name, x, {}, colour};
    for (std::size_t row = 0; row < x.size(); ++row) {
      const double mean = unit * spread.mean[c][row],
                   sd = std::abs(unit) * spread.deviation[c][row];
      result.y.push_back(mean);
      result.low.push_back(mean - sd);
      result.high.push_back(mean + sd);
    }
    return result;
  };
  Panel stress{"Cauchy stress [kPa]", {}, 1.3};
  if (spheres) stress.curves.push_back(curve("−σ33, axial", "sigma33", -1e-3, colour::orange));
  stress.curves.push_back(
      curve("−σ22", "sigma22", -1e-3, spheres ? colour::green : colour::orange));
  stress.curves.push_back(curve("−σ11", "sigma11", -1e-3, colour::blue));
  if (shear) {
    const std::string sigma = "sigma" + abscissa.substr(1);
    stress.curves.push_back(curve("shear", sigma.c_str(), 1e-3, colour::purple));
  }
  return {
      title,
      shear ? "shear " + abscissa + " [-]"
            : (spheres ? "axial strain 1 - F33 [%]" : "axial strain 1 - F22 [%]"),
      {stress,
       {"volumetric strain, dilation + [%]", {curve("", "volumetric_strain", 100, colour::blue)}},
       {"coordination number [-]", {curve("", "coordination", 1, colour::blue)}}}};
}

}  // namespace

std::vector<Ensemble> ensembles_of(const SceneFile& file, const std::string& prefix) {
  std::vector<Ensemble> ensembles;
  const toml::array* cases = file.content["case"].as_array();
  if (cases == nullptr) return ensembles;
  for (const toml::node& node : *cases) {
    const toml::table* one = node.as_table();
    if (one == nullptr) continue;
    const int seeds = (*one)["seeds"].value_or(0);
    if (seeds < 2) continue;
    Ensemble ensemble{fmt::format("{}_{}", prefix, (*one)["name"].value_or(std::string())), {}};
    for (int seed = 1; seed <= seeds; ++seed)
      ensemble.members.push_back(fmt::format("{}_s{}", ensemble.name, seed));
    ensembles.push_back(std::move(ensemble));
  }
  return ensembles;
}

void write_ensemble(const Ensemble& ensemble, const std::filesystem::path& directory,
                    const std::string& abscissa, bool figure) {
  std::vector<CsvTable> tables;
  for (const std::string& member : ensemble.members) {
    const auto path = directory / (member + ".csv");
    if (!std::filesystem::is_regular_file(path)) continue;
    CsvTable table = read_csv(path);
    if (table.rows() > 0 && (tables.empty() || table.names == tables.front().names))
      tables.push_back(std::move(table));
  }
  const auto stem = directory / (ensemble.name + "_ensemble");
  if (tables.size() < 2) {
    if (std::filesystem::exists(stem.string() + ".csv"))
      fmt::print(
          "{}: found {} packings, expected 2 or more for an ensemble; {}.csv is of an earlier "
          "run\n",
          ensemble.name, tables.size(), terminal_text(stem.string()));
    return;
  }
  const Spread spread = spread_of(tables);
  const bool spheres = spread.column("sigma33") < spread.names.size();
  Written written(stem);
  write_table(spread, spheres, stem.string() + ".csv");
  written.add(".csv");
  if (figure)
    written.add_pictures(
        draw(figure_of(spread, spheres, abscissa,
                       fmt::format("mean and standard deviation of {} packings", tables.size())),
             stem));
  fmt::print("{}: {} packings, {} of them to the last step; {}\n", ensemble.name, tables.size(),
             spread.runs.back(), written.text());
}

}  // namespace verification

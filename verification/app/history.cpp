#include "app/history.hpp"

#include "app/stresses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace verification {

std::vector<std::string_view> abscissae(int dimension) {
  if (dimension == 2) return {axial_abscissa, shear_abscissa};
  return {axial_abscissa, shear_abscissa, "F13", "F23"};
}

History::History(std::filesystem::path stem, int dimension, bool drag)
    : stem_(std::move(stem)),
      drag_(drag),
      csv_(stem_.string() + ".csv",
           dimension == 3 ? record_columns<3>(drag) : record_columns<2>(drag)) {}

bool History::draw_figure(const std::string& abscissa) const {
  return draw_history(read_csv(csv_.path()), abscissa, stem_);
}

std::string History::summary(const Effort& unfinished) const {
  return history_summary(read_csv(csv_.path()), unfinished);
}

namespace {

constexpr double percent = 100;
constexpr double kilopascal = 1e-3;

// Columns of a history in units of figures.
class Columns {
 public:
  Columns(const CsvTable& table, std::string abscissa)
      : table_(table), abscissa_(std::move(abscissa)) {
    x_ = shear() ? column(abscissa_, 1) : column(axial_abscissa, percent);
    cycles_ = cycles_of(x_);
  }

  [[nodiscard]] bool cyclic() const { return !cycles_.empty(); }
  [[nodiscard]] bool shear() const { return abscissa_ != axial_abscissa; }
  [[nodiscard]] bool spheres() const {
    return std::find(table_.names.begin(), table_.names.end(), "sigma33") != table_.names.end();
  }
  [[nodiscard]] std::string abscissa_text() const {
    if (shear()) return "shear " + abscissa_ + " [-]";
    return spheres() ? "axial strain 1 - F33 [%]" : "axial strain 1 - F22 [%]";
  }
  // "13" of F13.
  [[nodiscard]] std::string sheared() const { return abscissa_.substr(1); }

  [[nodiscard]] std::vector<double> column(const std::string& name, double unit) const {
    std::vector<double> values = table_[name];
    for (double& value : values) value *= unit;
    return values;
  }
  [[nodiscard]] Curve curve(const std::string& title, const std::string& name, double unit,
                            const char* colour, Stroke stroke = Stroke::solid) const {
    return {title, x_, column(name, unit), colour, stroke};
  }
  [[nodiscard]] Curve curve(const std::string& title, std::vector<double> values,
                            const char* colour, Stroke stroke = Stroke::solid) const {
    return {title, x_, std::move(values), colour, stroke};
  }
  // A panel of one curve, its cycles told apart.
  [[nodiscard]] Panel panel(const std::string& ordinate, std::vector<double> values,
                            double height) const {
    Curve curve{"", x_, std::move(values)};
    curve.cycles = cycles_;
    return {ordinate, {curve}, height};
  }
  [[nodiscard]] Stresses stresses() const { return stresses_of(table_); }

 private:
  const CsvTable& table_;
  std::string abscissa_;
  std::vector<double> x_;
  std::vector<int> cycles_;
};

std::vector<Panel> stress_of_discs(const Columns& columns) {
  return {{"Cauchy stress [kPa]",
           {columns.curve("−σ11", "sigma11", -kilopascal, colour::blue),
            columns.curve("−σ22", "sigma22", -kilopascal, colour::orange),
            columns.curve("σ12", "sigma12", kilopascal, colour::green)},
           1.3}};
}

std::vector<Panel> stress_of_spheres(const Columns& columns) {
  Panel stress{"Cauchy stress [kPa]",
               {columns.curve("−σ33, axial", "sigma33", -kilopascal, colour::orange),
                columns.curve("−σ22", "sigma22", -kilopascal, colour::green),
                columns.curve("−σ11", "sigma11", -kilopascal, colour::blue, Stroke::dashed)},
               1.2};
  if (columns.shear())
    stress.curves.push_back(columns.curve("σ" + columns.sheared(), "sigma" + columns.sheared(),
                                          kilopascal, colour::purple));
  const Stresses s = columns.stresses();
  Panel invariants{"q and p [kPa]", {}, 0.9};
  if (columns.shear())
    invariants.curves.push_back(
        columns.curve("q of the stress deviator", "deviatoric_stress", kilopascal, colour::purple));
  else
    invariants.curves.push_back(
        columns.curve("q, axial less lateral", s.deviatoric(), colour::purple));
  invariants.curves.push_back(
      columns.curve("mean pressure p", s.mean, colour::black, Stroke::dashed));
  return {stress, invariants};
}

// Where curves of several stresses would hide each other.
std::vector<Panel> stress_of_cycles(const Columns& columns) {
  const Stresses s = columns.stresses();
  return {columns.shear()
              ? columns.panel("shear stress [kPa]",
                              columns.column("sigma" + columns.sheared(), kilopascal), 1.3)
              : columns.panel("axial less lateral stress q [kPa]", s.deviatoric(), 1.3),
          columns.panel("mean pressure p [kPa]", s.mean, 1)};
}

Panel fabric_of_spheres(const Columns& columns) {
  return {"fabric [-]",
          {columns.curve("33, axial", "fabric33", 1, colour::orange),
           columns.curve("22", "fabric22", 1, colour::green),
           columns.curve("11", "fabric11", 1, colour::blue, Stroke::dashed)},
          0.9};
}

}  // namespace

std::string strain_text(const std::string& abscissa, double strain) {
  return abscissa == axial_abscissa ? fmt::format("axial strain {:.3g} [%]", percent * strain)
                                    : fmt::format("{} = {:.3g} [-]", abscissa, strain);
}

bool draw_history(const CsvTable& table, const std::string& abscissa,
                  const std::filesystem::path& stem) {
  if (table.rows() == 0) return false;
  const Columns columns(table, abscissa);
  const bool spheres = columns.spheres();
  Figure figure{"", columns.abscissa_text(),
                columns.cyclic() ? stress_of_cycles(columns)
                : spheres        ? stress_of_spheres(columns)
                                 : stress_of_discs(columns)};
  const auto volumetric = columns.column("volumetric_strain", percent);
  const auto [least, most] = std::minmax_element(volumetric.begin(), volumetric.end());
  constexpr double isochoric = 1e-9;  // % below which strains are not drawn
  if (*most - *least > isochoric)
    figure.panels.push_back(columns.panel("volumetric strain, dilation + [%]", volumetric, 1));
  if (columns.cyclic()) {
    figure.panels.push_back(
        columns.panel("coordination number [-]", columns.column("coordination", 1), 1));
    return draw(figure, stem);
  }
  figure.panels.push_back({"coordination number [-]",
                           {columns.curve("all particles", "coordination", 1, colour::blue),
                            columns.curve("without rattlers", "coordination_no_rattlers", 1,
                                          colour::orange, Stroke::dashed)},
                           1});
  if (spheres) figure.panels.push_back(fabric_of_spheres(columns));
  return draw(figure, stem);
}

std::string much_drag_text(const CsvTable& table) {
  if (std::find(table.names.begin(), table.names.end(), "unbalanced") == table.names.end())
    return {};
  const std::vector<double>& values = table["unbalanced"];
  const auto above =
      std::count_if(values.begin(), values.end(), [](double value) { return value > much_drag; });
  if (above == 0) return {};
  return fmt::format(
      "\n  unbalanced up to {:.2g} [-], above {:g} in {} steps: drag carries part of the load; a "
      "smaller solver.viscous_number lowers it",
      *std::max_element(values.begin(), values.end()), much_drag, above);
}

std::string history_summary(const CsvTable& table, const Effort& unfinished) {
  const auto sum = [&](const char* name, double more) {
    const std::vector<double>& values = table[name];
    return std::accumulate(values.begin(), values.end(), more);
  };
  return fmt::format(
      "{:.0f} steps, {:.0f} iterations, {:.0f} evaluations, {:.0f} relaxation steps, "
      "{:.0f} factorisations, {:.0f} cuts, {:.0f} loose, {:.0f} with advanced history{}",
      table.rows() == 0 ? 0 : table["step"].back(), sum("newton_iterations", unfinished.iterations),
      sum("evaluations", unfinished.evaluations),
      sum("relaxation_steps", static_cast<double>(unfinished.relaxation_steps)),
      sum("factorisations", unfinished.factorisations), sum("step_cuts", unfinished.cuts),
      sum("loose_parts", unfinished.loose), sum("history_advanced", unfinished.history_advanced),
      much_drag_text(table));
}

}  // namespace verification

#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include "app/csv.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <string>

namespace verification::drag {
namespace {

constexpr double end = 0.1;
constexpr int steps = 100;
constexpr double early_bound = 0.3;  // of the stress to 1 % [%]
constexpr double peak_bound = 1;     // [%]
constexpr double errors_bound = 2;   // standard errors of what is compared

double early(const Drained& path) { return 1e-3 * path.mean_between(1e-3, 0.01); }
double peak(const Drained& path) { return 1e-3 * largest(path.stress); }
double late(const Drained& path) { return 1e-3 * path.mean_between(0.06, end); }
double dilation(const Drained& path) { return 100 * path.dilation; }

// Equilibrium is got over its jumps as in the study of ensembles.
template <int D>
Drained run(Study& study, const Packing& packing, bool in_time) {
  const Setting setting{.in_time = in_time, .from_trial = !in_time};
  return drained<D>(study.materials(packing, setting), end, steps,
                    in_time ? PointOptions{} : study_options());
}

// Mean of stress over YADE's at the steps to 1 %, less 1 [%].
double early_over(const Drained& path, const CsvTable& curve) {
  std::vector<double> over;
  for (std::size_t k = 1; k < path.strain.size() && path.strain[k] < 0.01 + 1e-9; ++k)
    over.push_back(path.stress[k] /
                       interpolate(curve["axial_strain"], curve["axial_stress"], path.strain[k]) -
                   1);
  return 100 * average(over);
}

// The packings of YADE's curves.
void compare_curves(Study& study) {
  struct Curve {
    const char* packing;
    const char* file;
    double young;
  };
  constexpr std::array<Curve, 4> curves{{{"rve400", "yade_biax400_I1e-5.csv", 6e8},
                                         {"rve400", "yade_biax400_I1e-4.csv", 6e8},
                                         {"spheres500", "yade_triaxial500_I2e-4.csv", 1e8},
                                         {"spheres500", "yade_triaxial500_I1e-3.csv", 1e8}}};
  Findings findings(
      study.options(), "yade",
      "drained to 10 % in 100 steps, the packings of YADE's curves: over the curve; peak and "
      "dilation of one packing beyond it are chance",
      {"packing", "curve", "law", "peak[kPa]", "yade_peak[kPa]", "mean_6_10[kPa]", "dilation[%]",
       "yade_dilation[%]", "unbalanced[%]", "iterations[-]", "cuts[-]", "ended[-]"},
      {{"to_1[%]"}, {"peak_apart[%]"}});
  std::map<std::string, Drained> paths;  // by packing and law
  for (const Curve& curve : curves) {
    const int dimension = curve.young == 6e8 ? 2 : 3;
    const CsvTable yade = read_csv(study.options().scene(std::string("reference/") + curve.file));
    const double yade_peak = 1e-3 * largest(yade["axial_stress"]);
    for (const bool in_time : {false, true}) {
      if (!in_time && dimension == 3) continue;  // `verification/run triaxial`, half an hour
      const std::string law = in_time ? "in time" : "equilibrium";
      const auto [entry, is_new] = paths.try_emplace(curve.packing + law);
      Drained& path = entry->second;
      if (is_new)
        path = in_dimension(dimension, [&](auto d) {
          return run<d>(study,
                        {.dimension = dimension, .young = curve.young, .file = curve.packing},
                        in_time);
        });
      const double over = early_over(path, yade);
      const double apart = std::abs(100 * (peak(path) / yade_peak - 1));
      findings.row(
          {curve.packing, curve.file, law, peak(path), yade_peak, late(path), dilation(path),
           100 * interpolate(yade["axial_strain"], yade["volumetric_strain"], 0.0999),
           100 * average(path.unbalanced),
           static_cast<double>(path.effort.iterations) / std::max(path.steps, 1),
           static_cast<double>(path.effort.cuts), path.failure.empty() ? "yes" : "no"},
          {{std::abs(over), in_time ? early_bound : told}, {apart, in_time ? peak_bound : told}});
    }
  }
  findings.print();
}

// The viscous number beside YADE's inertial number: stress to 1 % and its peak, over YADE's slowest.
void compare_rates(Study& study) {
  const Packing packing{.file = "rve400"};
  const auto curve = [&](const char* rate) {
    return read_csv(study.options().scene(fmt::format("reference/yade_biax400_I{}.csv", rate)));
  };
  const CsvTable slowest = curve("1e-5");
  const double slowest_peak = largest(slowest["axial_stress"]);
  Findings findings(study.options(), "yade_rates",
                    "drained to 3 %, rve400: the viscous number of steps of 0.1 %, and YADE's "
                    "inertial number, over YADE at 1e-5",
                    {"law", "number", "to_1[%]", "peak[%]", "unbalanced[%]"}, {});
  const auto add = [&](const char* law, const std::string& number, const Drained& path) {
    findings.row({law, number, early_over(path, slowest),
                  100 * (largest(path.stress) / slowest_peak - 1), 100 * average(path.unbalanced)},
                 {});
  };
  for (const char* rate : {"1e-3", "3e-4", "1e-4"}) {
    const CsvTable yade = curve(rate);
    Drained path;
    for (int k = 1; k <= 30; ++k) {
      path.strain.push_back(1e-3 * k);
      path.stress.push_back(
          interpolate(yade["axial_strain"], yade["axial_stress"], path.strain.back()));
    }
    add("YADE", rate, path);
  }
  for (const double share : {0.1, 0.3, 1.0, 3.0, 10.0}) {
    const Material material = study.materials(packing, {.share = share});
    add("in time", fmt::format("{:g}", share * study.materials.number()),
        drained<2>(material, 0.03, 30, {}));
  }
  findings.print();
}

// Eight packings of one recipe, beside YADE's eight (verification/scenes/reference/README.md).
void compare_ensembles(Study& study) {
  constexpr double yade_packings = 8;
  struct Quantity {
    const char* name;
    double (*value)(const Drained&);
    double yade_mean, yade_deviation;
    double bound;  // of the distance from equilibrium [% of it]; 0: two standard errors of it
  };
  constexpr std::array<Quantity, 4> quantities{{{"stress to 1 % [kPa]", early, 0, 0, early_bound},
                                                {"peak [kPa]", peak, 294.6, 14.5, peak_bound},
                                                {"6 to 10 % [kPa]", late, 208.7, 9.9, 0},
                                                {"dilation [%]", dilation, 3.95, 0.52, 0}}};
  const std::vector<Packing> packings = discs(study.packings(8));
  std::array<std::vector<Drained>, 2> paths;
  for (const Packing& packing : packings)
    for (const bool in_time : {false, true})
      paths[in_time ? 1 : 0].push_back(run<2>(study, packing, in_time));
  Findings findings(
      study.options(), "yade_ensemble",
      "the same of packings of one recipe: the law less equilibrium, packing by packing, and its "
      "distance from YADE's mean over the standard error of both",
      {"packings", "quantity", "law", "s.e.", "equilibrium", "less_equilibrium", "s.e._of_it",
       "yade", "yade_s.e."},
      {{"from_equilibrium[%]"}, {"from_equilibrium[s.e.]"}, {"from_yade[s.e.]"}});
  for (const Quantity& quantity : quantities) {
    std::vector<double> law, rest, apart;
    for (std::size_t k = 0; k < packings.size(); ++k) {
      rest.push_back(quantity.value(paths[0][k]));
      law.push_back(quantity.value(paths[1][k]));
      apart.push_back(law.back() - rest.back());
    }
    const double yade_error = quantity.yade_deviation / std::sqrt(yade_packings);
    const bool in_yade = quantity.yade_mean > 0;
    const Table::Cell none("");
    findings.row(
        {fmt::format("{} packings", packings.size()), quantity.name, average(law),
         standard_error(law), average(rest), average(apart), standard_error(apart),
         in_yade ? Table::Cell(quantity.yade_mean) : none,
         in_yade ? Table::Cell(yade_error) : none},
        {{std::abs(100 * average(apart) / average(rest)),
          quantity.bound > 0 ? quantity.bound : told},
         {std::abs(average(apart)) / standard_error(apart),
          quantity.bound > 0 ? told : errors_bound},
         {std::abs(average(law) - quantity.yade_mean) / std::hypot(standard_error(law), yade_error),
          in_yade ? errors_bound : told}});
  }
  findings.print();
}

}  // namespace

void compare_with_yade(Study& study) {
  compare_rates(study);
  compare_curves(study);
  compare_ensembles(study);
}

}  // namespace verification::drag

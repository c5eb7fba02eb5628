// Figures 11 and 12: an infinite layer, cohesive and frictional, under vertical stress and shear.

#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace verification {
namespace {

constexpr int drawn = 5, packings = 16;  // of figure_12.toml; with those of figure_12_more.toml
constexpr double residual_from = 0.15;   // F12 from which on the ratio counts as residual

std::string layer(const char* law, int packing) {
  return fmt::format("figure_12_{}{}_{}", packing > drawn ? "more_" : "", law, packing);
}

// -sigma12 / sigma22 at every step: both shear stresses, which differ by the moments of D sides.
std::vector<double> ratio(const PaperRun& run, const char* shear = "sigma12") {
  std::vector<double> values = run.history[shear];
  const std::vector<double>& normal = run.history["sigma22"];
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::abs(values[k] / normal[k]);
  return values;
}

// det F relative to the start, which is under the vertical stress.
std::vector<double> volume(const PaperRun& run) {
  std::vector<double> values = run.history["volumetric_strain"];
  const double start = 1 + values.front();
  for (double& value : values) value = (1 + value) / start;
  return values;
}

struct Strength {
  double peak = 0, peak_at = 0;  // sigma12 / sigma22 [-], F12 [-]
  double residual = 0;           // mean of the ratio beyond residual_from [-]
  double residual_21 = 0;        // the same of sigma21
  double volume = 1;             // det F at the end
  double until = 0;              // F12 of the last step
  double volume_at_peak = 1;
  // Bonds since the packing was made, at the start of shear, at the peak and at the end.
  double broken_start = 0, broken_at_peak = 0, broken = 0;
  double contacts = 0;  // at the start
};

Strength strength(const PaperRun& run) {
  const std::vector<double>& shear = run.history["F12"];
  const std::vector<double> r = ratio(run), r21 = ratio(run, "sigma21");
  Strength s;
  // What slides at once at F12 = 0 under the vertical stress alone is no peak.
  const auto top = std::max_element(r.begin(), r.end());
  s.peak = *top;
  s.peak_at = shear[static_cast<std::size_t>(top - r.begin())];
  double count = 0;
  for (std::size_t k = 0; k < r.size(); ++k)
    if (shear[k] >= residual_from - 1e-9) {
      s.residual += r[k];
      s.residual_21 += r21[k];
      ++count;
    }
  s.residual = count > 0 ? s.residual / count : std::nan("");
  s.residual_21 = count > 0 ? s.residual_21 / count : std::nan("");
  s.volume = volume(run).back();
  s.until = shear.back();
  s.broken_start = run.history["broken_bonds"].front();
  s.broken = run.history["broken_bonds"].back();
  const auto peak = static_cast<std::size_t>(top - r.begin());
  s.volume_at_peak = volume(run)[peak];
  s.broken_at_peak = run.history["broken_bonds"][peak];
  s.contacts = run.history["contacts"].front();
  return s;
}

// Change from residual_from to the end along a line through all steps between; NaN without two.
double late_change(const PaperRun& run, const std::vector<double>& values) {
  const std::vector<double>& shear = run.history["F12"];
  double count = 0, x = 0, y = 0, xy = 0, xx = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (shear[k] < residual_from - 1e-9) continue;
    ++count, x += shear[k], y += values[k];
    xy += shear[k] * values[k], xx += shear[k] * shear[k];
  }
  const double slope = (count * xy - x * y) / (count * xx - x * x);
  return std::abs(slope) * (shear.back() - residual_from);
}

double rotation_at(const PaperRun& run, double shear) {
  if (!run.particles) return std::nan("");
  return interpolate((*run.particles)["F12"], (*run.particles)["mean_rotation_magnitude"], shear);
}

void figure_11(const PaperStudy& study) {
  struct Kind {
    const char* name;
    const char* colour;
  };
  Panel stress{"σ12 / σ22 [-]", {}, 1.2};
  Panel dilation{"det F from the start of shear [-]"};
  Panel rotation{"mean |rotation| [rad]"};
  for (const Kind kind : {Kind{"frictional", colour::blue}, Kind{"cohesive", colour::orange},
                          Kind{"strong", colour::green}})
    for (int k = 1; k <= drawn; ++k) {
      const auto run = study.run(layer(kind.name, k));
      if (!run) continue;
      const Stroke stroke = k == 1 ? Stroke::solid : Stroke::thin;
      const std::string title = k == 1 ? kind.name : "";
      const std::vector<double> x = run->column("F12");
      stress.curves.push_back({title, x, ratio(*run), kind.colour, stroke});
      dilation.curves.push_back({title, x, volume(*run), kind.colour, stroke});
      if (run->particles)
        rotation.curves.push_back({title, (*run->particles)["F12"],
                                   (*run->particles)["mean_rotation_magnitude"], kind.colour,
                                   stroke});
    }
  if (stress.curves.empty()) return;
  Figure figure{"Fig. 11: five layers; thick: the first", "F12 [-]", {stress, dilation}};
  if (!rotation.curves.empty()) figure.panels.push_back(rotation);
  draw(figure, study.results / "figure_11");
}

double mean(const std::vector<double>& values) {
  return values.empty() ? std::nan("")
                        : std::accumulate(values.begin(), values.end(), 0.0) /
                              static_cast<double>(values.size());
}

// Standard error of a mean over the packings.
void spread(PaperStudy& study, std::map<std::string, std::vector<double>>& found, const char* fact,
            const char* law) {
  const std::string name = fmt::format(fmt::runtime(fact), law);
  const std::vector<double>& values = found[name + "_mean"];
  double squares = 0;
  for (const double value : values) squares += std::pow(value - mean(values), 2);
  const auto count = static_cast<double>(values.size());
  study.facts.add(name + "_error", std::sqrt(squares / (count - 1) / count));
}

void compare_layers(PaperStudy& study) {
  Table table(
      "Layer: cohesive and frictional",
      {"packing[-]", "law", "peak_s12_over_s22[-]", "F12_at_peak[-]", "residual_s12_over_s22[-]",
       "residual_s21_over_s22[-]", "det_F_end[-]", "until_F12[-]", "contacts_start[-]",
       "broken_start[-]", "broken_end[-]", "peak_over_frictional[-]"});
  const CaseEnds ends(study.results / "figure_12_cases.csv");
  std::map<std::string, std::vector<double>> found;  // by fact, a number per packing
  for (int k = 1; k <= packings; ++k) {
    const auto frictional = study.run(layer("frictional", k));
    if (!frictional) continue;
    const Strength base = strength(*frictional);
    const auto strong = study.run(layer("strong", k));
    for (const char* law : {"frictional", "cohesive", "strong"}) {
      const auto run = study.run(layer(law, k));
      if (!run) continue;
      const Strength s = strength(*run);
      table.row({static_cast<double>(k), law, s.peak, s.peak_at, s.residual, s.residual_21,
                 s.volume, s.until, s.contacts, s.broken_start, s.broken, s.peak / base.peak});
      const auto note = [&](const char* fact, double value) {
        found[fmt::format(fmt::runtime(fact), law)].push_back(value);
      };
      note("layer.{}.peak_at_mean", s.peak_at);
      note("layer.{}.gain_mean", s.peak / base.peak);
      note("layer.{}.residual_mean", s.residual);
      note("layer.{}.residual_over_frictional", s.residual / base.residual);
      note("layer.{}.volume_at_peak_mean", s.volume_at_peak);
      note("layer.{}.ratio_change_mean", late_change(*run, ratio(*run)) / s.peak);
      note("layer.{}.volume_change_mean", late_change(*run, volume(*run)) / std::abs(s.volume - 1));
      if (run->particles)
        note("layer.{}.rotation_growth",
             rotation_at(*run, 0.2) /
                 rotation_at(*run, law == std::string("frictional") ? 0.07 : 0.12));
      // Bonds of the same packing, of which none breaks when they are 20 times as strong.
      if (strong) {
        note("layer.{}.broken_at_start_mean", s.broken_start / strength(*strong).contacts);
        note("layer.{}.broken_at_peak_mean", s.broken_at_peak / strength(*strong).contacts);
      }
      if (const auto end = ends.find(run->name); end && run->name == frictional->name)
        found["layer.particles_mean"].push_back(ends.table["particles"][*end]);
    }
    found["layer.fraction_mean"].push_back(1 / (1 + frictional->history["void_ratio"].front()));
    const auto cohesive = study.run(layer("cohesive", k));
    if (!cohesive) continue;
    const auto early = [](const PaperRun& run) {
      return interpolate(run.history["F12"], ratio(run), 0.02);
    };
    found["layer.cohesive_over_frictional_0.02"].push_back(early(*cohesive) / early(*frictional));
    if (frictional->particles && cohesive->particles)
      found["layer.start_rotation_frictional_over_cohesive"].push_back(rotation_at(*frictional, 0) /
                                                                       rotation_at(*cohesive, 0));
  }
  if (found.empty()) return;
  table.print();
  table.write(study.results / "layer.csv");
  for (const auto& [fact, values] : found) study.facts.add(fact, mean(values));
  study.facts.add("layer.packings", static_cast<double>(found["layer.fraction_mean"].size()));
  for (const char* law : {"frictional", "cohesive", "strong"}) {
    spread(study, found, "layer.{}.residual", law);
    spread(study, found, "layer.{}.peak_at", law);
    spread(study, found, "layer.{}.gain", law);
  }
}

// Cases WHAT of a scene, one row each.
void tabulate(const PaperStudy& study, const char* scene, const std::string& title,
              const std::vector<std::string>& cases) {
  Table table(title, {"case", "peak_s12_over_s22[-]", "F12_at_peak[-]", "residual_s12_over_s22[-]",
                      "residual_s21_over_s22[-]", "det_F_end[-]", "until_F12[-]",
                      "contacts_start[-]", "broken_start[-]", "broken_end[-]"});
  bool any = false;
  for (const std::string& name : cases) {
    const auto run = study.run(fmt::format("{}_{}", scene, name));
    if (!run) continue;
    any = true;
    const Strength s = strength(*run);
    table.row({name, s.peak, s.peak_at, s.residual, s.residual_21, s.volume, s.until, s.contacts,
               s.broken_start, s.broken});
  }
  if (!any) return;
  table.print();
  table.write(study.results / (std::string(scene) + ".csv"));
}

// liu2019_biaxial, fig. 10: locked rotation.
void locked_rotation(PaperStudy& study) {
  const auto free = study.run("locked_rotation_free");
  const auto locked = study.run("locked_rotation_locked");
  if (!free || !locked) return;
  const auto deviator = [](const PaperRun& run) {
    std::vector<double> q = run.history["sigma11"];
    for (std::size_t k = 0; k < q.size(); ++k) q[k] -= run.history["sigma22"][k];
    return *std::max_element(q.begin(), q.end());
  };
  const double a = deviator(*free), b = deviator(*locked);
  Table table("Locked rotation, drained biaxial compression",
              {"rotation", "peak_deviator[Pa]", "over_free[-]"});
  table.row({"free", a, 1.0});
  table.row({"locked", b, b / a});
  table.print();
  table.write(study.results / "locked_rotation.csv");
  study.facts.add("locked_rotation.gain", b / a);
}

}  // namespace

void study_layer(PaperStudy& study) {
  figure_11(study);
  compare_layers(study);
  tabulate(study, "layer_strength", "Layer: bond strength",
           {"frictional", "x1", "x2", "x5", "x10", "x20", "x50"});
  tabulate(study, "layer_rows", "Layer: top and bottom rows",
           {"discs", "rigid", "discs_low", "rigid_low", "rigid_fixed"});
  const auto free = study.run("layer_rows_rigid"), fixed = study.run("layer_rows_rigid_fixed");
  if (free && fixed)
    study.facts.add("layer_rows.peak_free_over_fixed",
                    strength(*free).peak / strength(*fixed).peak);
  locked_rotation(study);
}

}  // namespace verification

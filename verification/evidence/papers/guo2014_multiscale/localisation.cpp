// Figures 10, 12 and 13: biaxial compression of a specimen that localises, on several meshes.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

namespace verification {
namespace {

constexpr double percent = 100;
constexpr double width = 50e-3;  // of the specimen [m]

struct Response {
  std::string title;
  std::vector<double> strain;  // axial [%]
  std::vector<double> stress;  // axial, compression positive [kPa]

  [[nodiscard]] std::size_t peak() const {
    return static_cast<std::size_t>(std::max_element(stress.begin(), stress.end()) -
                                    stress.begin());
  }
};

// Force on the top over its current width: the mean of F11 over the points is that over the area.
Response response(const MeshRun& run, const std::string& title) {
  Response r{title, {}, {}};
  for (std::size_t k = 0; k < run.steps(); ++k) {
    r.strain.push_back(percent * run.history["axial_strain"][k]);
    r.stress.push_back(1e-3 * std::abs(run.forces["top_y_force"][k]) /
                       (width * run.history["F11"][k]));
  }
  return r;
}

Response response(const PaperRun& run, const std::string& title) {
  return {title, run.column("axial_strain", percent), run.column("sigma22", -1e-3)};
}

struct Mesh {
  const char* name;
  const char* title;
  const char* colour;
};
// To the peak alone.
constexpr std::array<Mesh, 5> meshes_to_the_peak{
    {{"biaxial_2x4_full", "2 x 4, points solved in full", colour::amber},
     {"biaxial_3x5_full", "3 x 5, points solved in full", colour::grey},
     {"biaxial_6x10_full", "6 x 10, points solved in full", colour::blue},
     {"biaxial_2x4_fine", "2 x 4, steps of 0.025 %", colour::amber},
     {"biaxial_6x10_fine", "6 x 10, steps of 0.025 %", colour::blue}}};
constexpr std::array<Mesh, 6> meshes{{{"biaxial_2x4", "2 x 4", colour::amber},
                                      {"biaxial_3x5", "3 x 5", colour::grey},
                                      {"biaxial_6x10", "6 x 10", colour::blue},
                                      {"biaxial_10x15", "10 x 15", colour::green},
                                      {"biaxial_12x20", "12 x 20", colour::purple},
                                      {"biaxial_6x10_q8", "6 x 10, Q8", colour::orange}}};

// Largest |a / b - 1| of the stresses up to a strain [%], over the common steps.
double difference(const Response& a, const Response& b, double until) {
  double largest = 0;
  for (std::size_t k = 0; k < a.strain.size(); ++k) {
    if (a.strain[k] > until + 1e-6) break;
    const double other = interpolate(b.strain, b.stress, a.strain[k]);
    if (std::isfinite(other)) largest = std::max(largest, std::abs(a.stress[k] / other - 1));
  }
  return largest;
}

void newton_facts(HierarchicalStudy& study, const MeshRun& run, const Response& r) {
  int quick = 0;
  double most = 0, cuts = 0, loose = 0;
  for (std::size_t k = 1; k < run.steps(); ++k) {
    const double iterations = run.history["newton_iterations"][k];
    const bool whole = run.history["step_cuts"][k] == 0 && run.history["loose_parts"][k] == 0;
    if (k <= r.peak()) {
      quick += iterations <= 5 && whole ? 1 : 0;
      most = std::max(most, iterations);
    } else {
      cuts += run.history["step_cuts"][k];
      loose += run.history["loose_parts"][k] > 0 ? 1 : 0;
    }
  }
  const auto steps = static_cast<double>(std::min(r.peak(), run.steps() - 1));
  study.facts.add(fmt::format("{}.newton.share_within_five", run.name), quick / steps);
  study.facts.add(fmt::format("{}.newton.most_before_peak", run.name), most);
  study.facts.add(fmt::format("{}.newton.cuts_after_peak", run.name), cuts);
  study.facts.add(fmt::format("{}.newton.loose_after_peak", run.name), loose);
}

// Least and largest value over the points after a step.
std::array<double, 2> range_of(const CsvTable& field, std::size_t step) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 2> ends{infinity, -infinity};
  for (std::size_t point = 1; point < field.columns.size(); ++point) {
    ends[0] = std::min(ends[0], field.columns[point][step]);
    ends[1] = std::max(ends[1], field.columns[point][step]);
  }
  return ends;
}

// Fields at the peak and at the end; nothing where a run did not get there.
void field_facts(HierarchicalStudy& study, const MeshRun& run, const Response& r) {
  constexpr double whole = 9.9;  // axial strain of a test to its end [%]
  struct Names {
    const char *field, *peak_least, *peak_most, *least, *most;
  };
  for (const Names& names : {Names{"deviatoric_strain", "{}.strain_at_peak_least",
                                   "{}.strain_at_peak_most", "{}.strain_least", "{}.strain_most"},
                             Names{"void_ratio", "{}.void_at_peak_least", "{}.void_at_peak_most",
                                   "{}.void_least", "{}.void_most"}}) {
    const auto table = load_every(study.results, run.name, names.field);
    if (!table || table->rows() == 0) continue;
    const auto add = [&](const char* least, const char* most, std::size_t step) {
      const auto ends = range_of(*table, step);
      study.facts.add(fmt::format(fmt::runtime(least), run.name), ends[0]);
      study.facts.add(fmt::format(fmt::runtime(most), run.name), ends[1]);
    };
    if (r.peak() + 1 < table->rows()) add(names.peak_least, names.peak_most, r.peak());
    if (r.strain.back() > whole) add(names.least, names.most, table->rows() - 1);
  }
}

// Mean stress from 6 to 10 % [kPa]; NaN of a run that ended before.
double softened(const Response& r) {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < r.strain.size(); ++k)
    if (r.strain[k] > 6 - 1e-6) sum += r.stress[k], ++count;
  return r.strain.back() > 9.9 ? sum / count : std::nan("");
}

void draw_meshes(HierarchicalStudy& study) {
  const auto rve = study.results / "rve.csv";
  Panel panel{"axial stress [kPa]", {}, 1.4};
  std::optional<Response> reference;
  if (std::filesystem::is_regular_file(rve)) {
    reference = response(*load_run(study.results, "rve"), "RVE alone");
    panel.curves.push_back(
        {"RVE alone", reference->strain, reference->stress, colour::black, Stroke::dashed});
  }
  std::optional<Response> first;
  std::map<std::string, double> late;  // mean stress from 6 to 10 % by mesh [kPa]
  for (const Mesh& mesh : meshes) {
    const auto run = load_mesh_run(study.results, mesh.name);
    if (!run || run->steps() < 3) continue;
    const Response r = response(*run, mesh.title);
    panel.curves.push_back({r.title, r.strain, r.stress, mesh.colour, Stroke::solid});
    newton_facts(study, *run, r);
    field_facts(study, *run, r);
    if (reference && r.peak() + 1 < r.stress.size())
      study.facts.add(fmt::format("{}.peak_over_rve", mesh.name),
                      r.stress[r.peak()] / reference->stress[reference->peak()]);
    if (first)
      study.facts.add(fmt::format("{}.apart_before_peak", mesh.name), difference(r, *first, 1.5));
    else
      first = r;
    late[mesh.name] = softened(r);
    study.facts.add(fmt::format("{}.mean_6_10", mesh.name), late[mesh.name]);
  }
  if (late.count("biaxial_10x15") > 0 && late.count("biaxial_12x20") > 0) {
    study.facts.add("meshes.medium_over_fine", late["biaxial_10x15"] / late["biaxial_12x20"]);
    if (late.count("biaxial_6x10") > 0)
      study.facts.add(
          "meshes.softening_largest_rise",
          largest_rise({late["biaxial_6x10"], late["biaxial_10x15"], late["biaxial_12x20"]}));
  }
  for (const Mesh& mesh : meshes_to_the_peak) {
    const auto run = load_mesh_run(study.results, mesh.name);
    if (run && run->steps() > 2) newton_facts(study, *run, response(*run, mesh.title));
  }
  if (panel.curves.empty()) return;
  draw({"biaxial compression, 50 x 100 mm", "axial strain [%]", {panel}},
       study.results / "figure_10");
}

void draw_hexagonal(HierarchicalStudy& study) {
  Panel panel{"axial stress [kPa]"};
  if (const auto rve = load_lattice(study.results)) {
    const Response r = response(*rve, "RVE alone");
    panel.curves.push_back({r.title, r.strain, r.stress, colour::black, Stroke::dashed});
    study.facts.add("hexagonal.rve.peak", r.stress[r.peak()]);
    study.facts.add("hexagonal.rve.peak_at", r.strain[r.peak()]);
  }
  // Meshes have drag, which delays the break: they are held against a lattice that has it too.
  std::optional<Response> with_drag;
  if (const auto rve = load_lattice(study.results, "rve_hexagonal_spread_drag")) {
    with_drag = response(*rve, "RVE alone, with drag");
    panel.curves.push_back(
        {with_drag->title, with_drag->strain, with_drag->stress, colour::black, Stroke::thin});
    study.facts.add("hexagonal.rve_drag.peak", with_drag->stress[with_drag->peak()]);
  }
  for (const char* name : {"biaxial_2x4_hexagonal", "biaxial_6x10_hexagonal"}) {
    const auto run = load_mesh_run(study.results, name);
    if (!run || run->steps() < 3) continue;
    const bool coarse = name[8] == '2';
    const Response r = response(*run, coarse ? "2 x 4" : "6 x 10");
    panel.curves.push_back({r.title, r.strain, r.stress, coarse ? colour::amber : colour::blue,
                            coarse ? Stroke::solid : Stroke::dashed});  // they lie on each other
    const std::size_t k = r.peak();
    if (k + 1 == r.stress.size()) continue;  // it ended there, or before the peak
    const auto add = [&](const char* fact, double value) {
      study.facts.add(fmt::format(fmt::runtime(fact), coarse ? "2x4" : "6x10"), value);
    };
    if (with_drag)
      add("hexagonal.{}.peak_over_rve_with_drag",
          r.stress[k] / with_drag->stress[with_drag->peak()]);
    add("hexagonal.{}.next_over_peak", r.stress[k + 1] / r.stress[k]);
    const auto last = std::minmax_element(r.stress.end() - r.stress.size() / 5, r.stress.end());
    add("hexagonal.{}.late_change", (*last.second - *last.first) / *last.second);
    const auto field = load_every(study.results, name, "deviatoric_strain");
    if (!field) continue;
    const auto [least, largest] = range_of(*field, k);
    add("hexagonal.{}.strain_at_peak_least", least);
    add("hexagonal.{}.strain_at_peak_most", largest);
  }
  if (panel.curves.empty()) return;
  draw({"biaxial compression, hexagonal packing", "axial strain [%]", {panel}},
       study.results / "figure_13");
}

// When one lattice breaks, by how much its radii differ.
void tabulate_spreads(const HierarchicalStudy& study) {
  Table table("One hexagonal packing by the spread of its radii",
              {"spread[-]", "peak[kPa]", "axial_strain[%]"});
  int rows = 0;
  for (const char* spread : {"3e-3", "5e-3", "7e-3", "8.5e-3", "1e-2"}) {
    const bool chosen = std::string_view(spread) == "8.5e-3";  // of the scenes
    const auto run =
        chosen ? load_lattice(study.results)
               : load_lattice(study.results, std::string("rve_hexagonal_spread_") + spread);
    if (!run || run->steps() < 3) continue;
    const Response r = response(*run, spread);
    table.row({std::stod(spread), r.stress[r.peak()], r.strain[r.peak()]});
    ++rows;
  }
  if (rows == 0) return;
  table.print();
  table.write(study.results / "hexagonal_spreads.csv");
}

}  // namespace

void study_localisation(HierarchicalStudy& study) {
  draw_meshes(study);
  draw_hexagonal(study);
  tabulate_spreads(study);
}

}  // namespace verification

// Figures 10, 12 and 13: biaxial compression of a specimen that localises, on several meshes.

#include "evidence/papers/guo2014_multiscale/multiscale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
  int steps = 0, quick = 0, most = 0, later = 0, loose = 0;
  double cuts = 0;
  for (std::size_t k = 1; k < run.steps(); ++k) {
    const int iterations = static_cast<int>(run.history["newton_iterations"][k]);
    if (k <= r.peak()) {
      ++steps;
      const bool whole = run.history["step_cuts"][k] == 0 && run.history["loose_parts"][k] == 0;
      quick += iterations <= 5 && whole ? 1 : 0;
      most = std::max(most, iterations);
    } else {
      ++later;
      cuts += run.history["step_cuts"][k];
      loose += run.history["loose_parts"][k] > 0 ? 1 : 0;
    }
  }
  study.facts.agree(
      "newton", fmt::format("{}: Newton before the peak, force residual 1e-6", r.title),
      "more than ten iterations at 5 %, displacement error 0.01",
      fmt::format("at most five iterations in {} of {} steps; most {}", quick, steps, most),
      10 * quick >= 9 * steps);
  if (later > 0)
    study.facts.add("newton", fmt::format("{}: after the peak", r.title), "not stated",
                    fmt::format("{} steps to {:.1f} %, {:.0f} cuts, {} steps with a part out of "
                                "balance",
                                later, r.strain.back(), cuts, loose),
                    "not stated");
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
  for (const Mesh& mesh : meshes) {
    const auto run = load_mesh_run(study.results, mesh.name);
    if (!run || run->steps() < 3) continue;
    const Response r = response(*run, mesh.title);
    panel.curves.push_back({r.title, r.strain, r.stress, mesh.colour, Stroke::solid});
    newton_facts(study, *run, r);
    const double peak = r.stress[r.peak()];
    if (reference && r.peak() + 1 < r.stress.size()) {
      const double other = reference->stress[reference->peak()];
      study.facts.agree(
          "10", r.title + ": peak against the RVE's", "close",
          fmt::format("{:.1f} kPa at {:.1f} %, RVE {:.1f} kPa at {:.1f} %: {:+.2f} %", peak,
                      r.strain[r.peak()], other, reference->strain[reference->peak()],
                      percent * (peak / other - 1)),
          std::abs(peak / other - 1) < 0.01);
    }
    if (first)
      study.facts.agree(
          "10", r.title + " against " + first->title + ", before the peak", "identical",
          fmt::format("apart by {:.1e} to 1 %, {:.1e} to {:.1f} %", difference(r, *first, 1),
                      difference(r, *first, 1.5), std::min(1.5, r.strain.back())),
          difference(r, *first, 1.5) < 0.01);
    else
      first = r;
    if (const auto strain = load_every(study.results, run->name, "deviatoric_strain")) {
      double least = std::numeric_limits<double>::infinity(), most = 0;
      for (std::size_t p = 1; p < strain->columns.size(); ++p) {
        least = std::min(least, strain->columns[p].back());
        most = std::max(most, strain->columns[p].back());
      }
      study.facts.add("12",
                      fmt::format("{}: deviatoric strain at {:.1f} %", r.title, r.strain.back()),
                      "a single band; largest at 10 %: 0.507 on 6 x 10, 0.809 on 12 x 20, 1.249 on "
                      "6 x 10 with Q8",
                      fmt::format("{:.3f} to {:.3f} over the points", least, most),
                      r.strain.back() < 9.9 ? "ended before"
                      : most > 3 * least    ? "localises; a band or not: see the pictures"
                                            : "differs");
    }
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
    study.facts.add("13", "RVE alone: peak", "1450 kPa at 2.8 %",
                    fmt::format("{:.0f} kPa at {:.1f} %", r.stress[r.peak()], r.strain[r.peak()]),
                    std::abs(r.strain[r.peak()] - 2.8) < 0.3 ? "agrees" : "differs");
  }
  for (const char* name : {"biaxial_2x4_hexagonal", "biaxial_6x10_hexagonal"}) {
    const auto run = load_mesh_run(study.results, name);
    if (!run || run->steps() < 3) continue;
    const bool coarse = name[8] == '2';
    const Response r = response(*run, coarse ? "2 x 4" : "6 x 10");
    panel.curves.push_back({r.title, r.strain, r.stress, coarse ? colour::amber : colour::blue,
                            coarse ? Stroke::solid : Stroke::dashed});  // they lie on each other
    const std::size_t k = r.peak();
    const bool beyond = k + 1 < r.stress.size();  // else it ended there, or before the peak
    study.facts.add("13", r.title + ": peak, and the next step", "near 2.8 %, then a sudden drop",
                    fmt::format("{:.0f} kPa at {:.1f} %, {}", r.stress[k], r.strain[k],
                                beyond ? fmt::format("then {:.0f} kPa", r.stress[k + 1])
                                       : "where the run ended"),
                    !beyond                             ? "ended before"
                    : std::abs(r.strain[k] - 2.8) < 0.3 ? "agrees"
                                                        : "differs");
    const auto field = load_every(study.results, name, "deviatoric_strain");
    if (!beyond || !field) continue;
    const auto range = [&](std::size_t step) {
      std::array<double, 2> ends{std::numeric_limits<double>::infinity(), 0};
      for (std::size_t point = 1; point < field->columns.size(); ++point) {
        ends[0] = std::min(ends[0], field->columns[point][step]);
        ends[1] = std::max(ends[1], field->columns[point][step]);
      }
      return ends;
    };
    const auto [least, largest] = range(k);
    const auto [least_next, largest_next] = range(k + 1);
    const bool localised = largest_next > 2 * least_next;
    const CsvTable newton = read_csv(study.results / (name + std::string("_newton.csv")));
    study.facts.agree(
        "13", r.title + ": deviatoric strain of the points at the peak, and in the next step",
        "0.0303 to 0.0305, then a slip line",
        fmt::format("{:.4f} to {:.4f}, then {:.4f} to {:.4f}, balanced to {:.1e}", least, largest,
                    least_next, largest_next, newton["relative_residual"].back()),
        localised);
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

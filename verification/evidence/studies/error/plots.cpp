// Pictures of `grainlaw_evidence error`.

#include "evidence/studies/error/error.hpp"

#include "app/figure.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification::error_study {
namespace {

// Gnuplot's point types, filled ones for what we recommend or compare with.
constexpr int disc = 7, ring = 6, square = 5, open_square = 4, triangle = 9, open_triangle = 8,
              diamond = 13, falling_triangle = 11;

void add_point(Curve& curve, double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y) || x <= 0 || y <= 0) return;
  curve.x.push_back(x);
  curve.y.push_back(y);
}

void add_curve(Panel& panel, const Curve& curve) {
  if (!curve.x.empty()) panel.curves.push_back(curve);
}

void save(const StudyOptions& options, const Figure& figure, const std::string& name) {
  const std::filesystem::path stem = std::filesystem::path(options.output) / name;
  if (draw(figure, stem)) fmt::print("picture: {0}.svg and {0}.png\n", stem.string());
}

void add_yade(Panel& panel, const std::vector<YadeRow>& yade) {
  Curve usual{"YADE, damping 0.1", {}, {}, colour::black, Stroke::thin, square};
  Curve best{"YADE, best setting", {}, {}, colour::black, Stroke::thin, open_square};
  Curve coupling{
      "YADE, as the FEM coupling ships it", {}, {}, colour::grey, Stroke::none, open_triangle};
  for (const YadeRow& row : yade) {
    Curve& curve = row.kind == "best" ? best : row.kind == "usual" ? usual : coupling;
    add_point(curve, 0.5 * (row.cpu_low + row.cpu_high), row.error);
  }
  for (const Curve& curve : {usual, best, coupling}) add_curve(panel, curve);
}

struct Look {
  const Method* method;
  const char* colour;
  int marker;
};

}  // namespace

void draw_increments(const StudyOptions& options, const std::vector<IncrementRow>& rows,
                     const std::vector<YadeRow>& yade) {
  Figure figure{"One increment of 0.1 % from an exact start, 400 discs, by tolerance",
                "CPU time of one evaluation [ms]",
                {},
                true};
  for (const char* path : {"drained", "shear"}) {
    Panel panel{fmt::format("{}: median error of P [-]", path), {}, 1.7, true};
    for (const Look& look : {Look{&direct, colour::blue, disc},
                             {&advancing, colour::green, triangle},
                             {&published, colour::orange, diamond},
                             {&frame_servo, colour::purple, falling_triangle}}) {
      Curve plain{look.method->name, {}, {}, look.colour, Stroke::solid, look.marker};
      Curve exact{fmt::format("{}, exact tangent", look.method->name),
                  {},
                  {},
                  colour::sky,
                  Stroke::dashed,
                  ring};
      for (const IncrementRow& row : rows) {
        if (row.path != path || row.method != look.method->name) continue;
        add_point(plain, row.cpu, row.error_median);
        add_point(exact, row.cpu_exact, row.error_median);
      }
      add_curve(panel, plain);
      if (look.method == &direct) add_curve(panel, exact);
    }
    add_yade(panel, yade);
    // One legend would hide the curves: ours in the first panel, YADE's in the second.
    for (Curve& curve : panel.curves)
      if (curve.title.starts_with("YADE") == figure.panels.empty()) curve.title.clear();
    figure.panels.push_back(panel);
  }
  save(options, figure, "error_increment");
}

void draw_paths(const StudyOptions& options, const std::vector<PathRow>& rows) {
  struct Line {
    const Method* method;
    double tolerance;
    const char* colour;
    int marker;
  };
  Figure figure{"Paths to 1 % strain, 400 discs; a point is an increment, from 1 % down",
                "CPU time of the path [ms]",
                {},
                true};
  for (const char* path : {"drained", "shear"}) {
    Panel panel{fmt::format("{}: largest error of P [-]", path), {}, 1.5, true, 1e-6};
    for (const Line& line : {Line{&direct, 1e-2, colour::grey, open_square},
                             {&direct, 1e-3, colour::sky, ring},
                             {&direct, 1e-4, colour::amber, open_triangle},
                             {&direct, 1e-6, colour::blue, disc},
                             {&advancing, 1e-4, colour::green, triangle},
                             {&published, 1e-3, colour::orange, diamond},
                             {&frame_servo, 1e-4, colour::purple, falling_triangle}}) {
      // Half of the legend in either panel: tolerances in the first, other methods in the second.
      const bool named = (line.method == &direct) == figure.panels.empty();
      Curve curve{named ? fmt::format("{}, tolerance {:.0e}", line.method->name, line.tolerance)
                        : std::string(),
                  {},
                  {},
                  line.colour,
                  Stroke::solid,
                  line.marker};
      for (const PathRow& row : rows)
        if (row.path == path && row.method == line.method->name &&
            std::abs(std::log(row.tolerance / line.tolerance)) < 0.1)
          add_point(curve, row.cpu, row.error);
      add_curve(panel, curve);
    }
    figure.panels.push_back(panel);
  }
  save(options, figure, "error_path");
}

void draw_numbers(const StudyOptions& options, const std::vector<NumberRow>& rows,
                  double exponent) {
  constexpr double bar = 1.5;
  Curve plain{"without a tangent", {}, {}, colour::sky, Stroke::dashed, ring};
  Curve exact{"with the exact tangent", {}, {}, colour::blue, Stroke::solid, disc};
  Curve slope{fmt::format("exponent {:g}", bar), {}, {}, colour::grey, Stroke::thin};
  for (const NumberRow& row : rows) {
    add_point(plain, row.particles, row.cpu);
    add_point(exact, row.particles, row.cpu_exact);
    add_point(slope, row.particles,
              rows.front().cpu_exact * std::pow(row.particles / rows.front().particles, bar));
  }
  Figure figure{fmt::format("Increments of 0.1 %, tolerance 1e-6; exponent {:.2f}", exponent),
                "number of particles [-]",
                {},
                true};
  figure.panels.push_back({"CPU time of one evaluation [ms]", {slope, plain, exact}, 2, true});
  save(options, figure, "error_number");
}

}  // namespace verification::error_study
